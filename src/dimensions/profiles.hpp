// Profiles across a feature, of the map's own points.
#pragma once

#include "dimensions/feature.hpp"

#include <vector>

namespace vkfv::dimensions {

struct ProfilePoint {
    double u = 0, v = 0; // mm, in the frame
    double height = 0;   // mm
};

// Profiles along u: each is a strip, as wide as the points' distance, of the measured points in ascending u. Points are
// not interpolated, whatever the feature's direction. v ascends from strip to strip; a strip may be empty.
struct Profiles {
    std::vector<std::vector<ProfilePoint>> lines;
    double spacing = 0; // mm, mean distance of points along u in a strip without gaps
};

Profiles profiles_across(const surface::HeightMap& map, const Frame& frame);

// The distances (mm) from the frame's origin to the map's border towards -u and towards +u; 0 if the origin lies
// outside.
struct Reach {
    double before = 0;
    double behind = 0;
};
Reach reach_along(const surface::HeightMap& map, const Frame& frame);

} // namespace vkfv::dimensions
