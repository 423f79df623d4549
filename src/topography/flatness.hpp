// The measurement of a flat shows the heights that the instrument adds: their size (flatness deviation), and a
// correction of its field curvature.
#pragma once

#include "core/mathematics/grid.hpp"
#include "surface/height_map.hpp"

#include <functional>

namespace vkfv::topography {

// The flatness deviation z_FLT of ISO 25178-600, mm: Sz, from the lowest to the highest measured point, of an ideal
// flat's measurement, after its least-squares plane and then waves shorter than the nesting index (mm; 0: none) are
// removed, the latter by the Gaussian S-filter. It includes curvature of the field and all that a polynomial does not
// follow, and the flat's own form, texture and noise as far as they are longer: an average of measurements has less.
// NaN without measured points.
double flatness_deviation(const surface::HeightMap& flat, double s_filter);

// Degree of the polynomial that is fitted to the measurement of a level flat (least squares), so that the flat's
// texture and the noise of its measurement are left out. Field curvature is even in the distance from the axis, and of
// fourth order beside the second; tilted instruments add odd terms.
inline constexpr int flatness_degree = 6;

struct FlatnessCorrected {
    surface::HeightMap heights;           // counted from the flat
    double polynomial_peak_to_valley = 0; // mm, of the removed polynomial, over the measured points
};

// Subtracts the flat's polynomial. Both maps are on one grid (std::invalid_argument otherwise). If the flat has no
// measured points, the result has none.
FlatnessCorrected correct_flatness(surface::HeightMap measured, const surface::HeightMap& flat);

// Adds to the standard uncertainty of heights the effect of a curved field that is not corrected: its distance from its
// own mean over the measured points is an error of known size, and adds by squares (JCGM 100:2008, F.2.4.5). curvature:
// height of a level surface at (x, y) as the instrument sees it; all in mm. Returns the curvature's peak-to-valley over
// the measured points, 0 without any. Both grids are of one size: std::invalid_argument otherwise.
double add_curvature(Grid<double>& uncertainty, const surface::HeightMap& measured,
                     const std::function<double(double x, double y)>& curvature);

} // namespace vkfv::topography
