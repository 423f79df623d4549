#include "topography/peak_method.hpp"

#include "topography/names.hpp"

namespace vkfv::topography {

const std::vector<std::string>& peak_method_names() {
    static const std::vector<std::string> names = {"gaussian", "parabola", "gaussian-fit", "polynomial-fit",
                                                   "centre-of-gravity"};
    return names;
}

const std::string& name_of(PeakMethod method) {
    return peak_method_names()[static_cast<std::size_t>(method)];
}

PeakMethod peak_method_from_name(std::string_view name) {
    return static_cast<PeakMethod>(
        place_of_name(name, peak_method_names(), "topography.peak", "Name one of the peak methods."));
}

} // namespace vkfv::topography
