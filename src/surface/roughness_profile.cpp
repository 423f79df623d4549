#include "surface/roughness_profile.hpp"

#include <algorithm>

namespace vkfv::surface {

ProfileLine middle_row(const HeightMap& map) {
    const double y = map.y(map.rows() / 2);
    return {.x_start = map.x(0), .y_start = y, .x_end = map.x(map.columns() - 1), .y_end = y};
}

RoughnessProfile roughness_profile(const HeightMap& map, const ProfileLine& line) {
    const double spacing = line.y_start == line.y_end   ? map.pitch_x
                           : line.x_start == line.x_end ? map.pitch_y
                                                        : std::min(map.pitch_x, map.pitch_y);
    RoughnessProfile result;
    result.profile = extract_profile(map, line.x_start, line.y_start, line.x_end, line.y_end, spacing);
    const auto points = result.profile.height.size();
    result.section_length = static_cast<double>(points - 1) * spacing / 5;
    // Of a section no longer than a spacing the filter leaves nothing.
    result.parameters = result.section_length > spacing
                            ? profile_parameters(remove_long_waves(result.profile, result.section_length))
                            : ProfileParameters{.ra = undefined, .rq = undefined, .rz = undefined};
    return result;
}

} // namespace vkfv::surface
