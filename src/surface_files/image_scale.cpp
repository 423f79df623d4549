#include "surface_files/image_scale.hpp"

#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace vkfv::surface {

void check_scale(const std::filesystem::path& file, const ImageScale& scale) {
    std::vector<InputProblem> problems;
    for (const auto& [key, value] : {std::pair{scale_pitch_key, scale.pitch}, {scale_unit_key, scale.unit}})
        if (!value || !(std::isfinite(*value) && *value > 0))
            problems.push_back(
                {.where = {.file = file},
                 .key = key,
                 .found = value ? fmt::format("{}", *value) : "not given",
                 .expected = "a positive length, which this file does not state",
                 .remedy = fmt::format("Give the {} that belongs to it; vkfv surface FILE --pitch_um P --unit_um U "
                                       "--out NAME.x3p writes a file that states its own.",
                                       key)});
    if (!problems.empty())
        throw InputError(std::move(problems));
}

void refuse_second_scale(const std::filesystem::path& file, const ImageScale& scale) {
    if (scale.pitch || scale.unit)
        refuse_file(file, scale.pitch ? scale_pitch_key : scale_unit_key, "given",
                    "no second scale: the file states its own", "Leave it out.");
}

} // namespace vkfv::surface
