// A flat, measured by an instrument, shows what the instrument adds to every height: how much that is, and a
// correction of its field curvature.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::topography {

// The flatness deviation z_FLT of ISO 25178-600, mm: Sz, from the lowest to the highest measured point, of what an
// ideal flat's measurement leaves after its least-squares plane is taken off and then waves shorter than the nesting
// index (mm; 0: none) by the Gaussian S-filter. Curvature of the field and all that a polynomial does not follow are
// in it, and the flat's own form, texture and noise as far as they are longer: an average of measurements has less.
// NaN without measured points.
double flatness_deviation(const surface::HeightMap& flat, double s_filter);

// What the instrument makes of a level flat at height 0, without the flat's texture and the noise of its measurement:
// the polynomial of this degree that fits it (least squares). Field curvature is even in the distance from the axis,
// and of fourth order beside the second; tilted instruments add odd terms.
inline constexpr int flatness_degree = 6;

struct FlatnessCorrected {
    surface::HeightMap heights;           // count from the flat now
    double polynomial_peak_to_valley = 0; // mm, of what was removed, over the measured points
};

// Both on one grid (std::invalid_argument otherwise). A flat without measured points leaves none.
FlatnessCorrected correct_flatness(surface::HeightMap measured, const surface::HeightMap& flat);

} // namespace vkfv::topography
