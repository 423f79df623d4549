// Profiles across a feature, made of the map's own points.
#pragma once

#include "dimensions/feature.hpp"

#include <vector>

namespace vkfv::dimensions {

struct ProfilePoint {
    double u = 0, v = 0; // mm, of the frame
    double height = 0;   // mm
};

// A strip along u, a point's distance wide, of the measured points in ascending u: not interpolated, whichever way the
// feature lies. v ascends from strip to strip; one may be empty.
struct Profiles {
    std::vector<std::vector<ProfilePoint>> lines;
    double spacing = 0; // mm between points along u, in the mean of a strip without gaps
};

Profiles profiles_across(const surface::HeightMap& map, const Frame& frame);

// How far the map reaches from the frame's origin along u: towards -u and towards +u, mm; 0 where the origin lies
// outside.
struct Reach {
    double before = 0;
    double behind = 0;
};
Reach reach_along(const surface::HeightMap& map, const Frame& frame);

} // namespace vkfv::dimensions
