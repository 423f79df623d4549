// A flat, measured by an instrument, shows what the instrument adds to every height: how much that is, and a
// correction of its field curvature.
#pragma once

#include "core/mathematics/grid.hpp"
#include "surface/height_map.hpp"

#include <functional>

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

// What a curved field that stays in the heights adds to their standard uncertainty: its distance from its own mean over
// the measured points is an error of known size that is not corrected, and adds by squares (JCGM 100:2008, F.2.4.5).
// curvature: height of a level surface at (x, y) as the instrument sees it; all in mm. Gives the curvature's
// peak-to-valley over the measured points, 0 without any. Both grids of one size: std::invalid_argument otherwise.
double add_curvature(Grid<double>& uncertainty, const surface::HeightMap& measured,
                     const std::function<double(double x, double y)>& curvature);

} // namespace vkfv::topography
