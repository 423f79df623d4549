// A profile of a surface and its roughness.
#pragma once

#include "surface/profile.hpp"

namespace vkfv::surface {

// In mm of the map's frame.
struct ProfileLine {
    double x_start = 0;
    double y_start = 0;
    double x_end = 0;
    double y_end = 0;
};

ProfileLine middle_row(const HeightMap& map);

struct RoughnessProfile {
    Profile profile;              // before the filter
    double section_length = 0;    // mm
    ProfileParameters parameters; // NaN for a profile of six points or fewer
};

// Points one pitch apart, the shorter pitch unless the line lies along an axis; roughness after the Gaussian filter
// whose nesting index is the section length, a fifth of the profile (ISO 21920-2).
RoughnessProfile roughness_profile(const HeightMap& map, const ProfileLine& line);

} // namespace vkfv::surface
