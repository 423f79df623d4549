// Hybrid parameters of ISO 25178-2:2012, 4.3.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The standard leaves open what lies between the points. Here every cell of four neighbouring points is four
// triangles that meet above its middle at the mean of the four heights: both parameters are integrals over
// these triangles, so that sdr is sdq^2 / 2 for small slopes. A cell with a not-measured corner is left out, of
// the area referred to as well. NaN without a whole cell. A sinusoid of n points a period keeps the share
// sin(pi / n) / (pi / n) of its slope.
struct HybridParameters {
    double sdq = 0; // root mean square gradient
    double sdr = 0; // developed interfacial area ratio: area of the surface over that of its projection, less one
};

HybridParameters hybrid_parameters(const HeightMap& map);

} // namespace vkfv::surface
