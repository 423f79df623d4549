#include "measurement/evaluation/brightness_warnings.hpp"

#include <fmt/format.h>

#include <string>

namespace vkfv::measurement {

std::vector<Warning> warnings_of_brightness(const Evaluation& evaluation) {
    constexpr double most_errors = 2; // beside them the standard error hardly counts
    std::string values;
    for (const auto& dimension : evaluation.dimensions) {
        if (dimension.brightness_uncertainty > most_errors * dimension.measured.standard_error) {
            const auto row = dimension.in_unit();
            values += fmt::format("{}{}, {:.2g} {}", values.empty() ? "" : "; ", row.name, row.brightness_uncertainty,
                                  row.unit);
        }
    }
    if (values.empty()) {
        return {};
    }
    return {
        {.code = "brightness-changes-with-focus",
         .key = "specimen.material",
         .value = {},
         .works = "light from more directions, or a specimen that scatters more widely",
         .sentence = fmt::format(
             "Brightness changes with focus where the surface is curved, since its light runs together or apart "
             "there, and moves the maxima of focus curves. This makes dimensions more uncertain than the scatter of "
             "the heights tells, by a standard uncertainty of ({}). It is the same in every repetition. Light the "
             "specimen from more directions, or take one that scatters more widely.",
             values)}};
}

} // namespace vkfv::measurement
