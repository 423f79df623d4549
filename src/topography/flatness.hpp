// Correction of the field curvature: a flat, measured by the same instrument, shows what it adds to every height.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::topography {

// What the instrument makes of a level flat at height 0, without the flat's texture and the noise of its measurement:
// the polynomial of this degree that fits it (least squares). Field curvature is even in the distance from the axis,
// and of fourth order beside the second; tilted instruments add odd terms.
inline constexpr int flatness_degree = 6;

struct FlatnessCorrected {
    surface::HeightMap heights; // count from the flat now
    double peak_to_valley = 0;  // mm, of what was removed, over the measured points: the flatness deviation z_FLT of
                                // ISO 25178-600
};

// Both on one grid (std::invalid_argument otherwise). A flat without measured points leaves none.
FlatnessCorrected correct_flatness(surface::HeightMap measured, const surface::HeightMap& flat);

} // namespace vkfv::topography
