#include "topography/peak_method.hpp"

#include "core/error.hpp"
#include "focus/focus.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace vkfv::topography {

const std::vector<std::string>& peak_method_names() {
    static const std::vector<std::string> names = {"gaussian", "parabola", "gaussian-fit", "polynomial-fit",
                                                   "centre-of-gravity"};
    return names;
}

int peak_method_from_name(std::string_view name) {
    const auto& names = peak_method_names();
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
        throw InputError({.where = {},
                          .key = "topography.peak",
                          .found = std::string(name),
                          .expected = fmt::format("\"{}\"", fmt::join(names, "\", \"")),
                          .remedy = "Name one of the peak methods."});
    return static_cast<int>(found - names.begin());
}

} // namespace vkfv::topography
