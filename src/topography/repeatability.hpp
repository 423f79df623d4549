// Separates a deviation into the part common to all repetitions and the random part of each.
#pragma once

#include "surface/height_map.hpp"

#include <span>

namespace vkfv::topography {

// A model of n repetitions: deviation = systematic(point) + random(point, repetition), the random part of mean zero,
// independent between repetitions (not between points). mm.
struct SystematicAndRandom {
    // Root of the mean square of the mean deviations, less random^2 / n, which their own scatter adds, so that the
    // square is free of bias (0 where the difference is negative).
    double systematic = 0;
    // Root of the sum of squared residuals over their degrees of freedom, n - 1 a point.
    double random = 0;
    // Standard errors by the jackknife over repetitions (Efron 1982), which needs no independence of points; NaN for
    // fewer than three.
    double systematic_error = 0;
    double random_error = 0;
    double points = 0;                     // number of points with two or more repetitions; others do not count
    surface::HeightMap mean_deviation;     // mm; NaN at the points that do not count
    surface::HeightMap standard_deviation; // mm, of one repetition; NaN at the points that do not count
};

// Separates both parts. deviations: measured minus true, of two or more repetitions on one grid: std::invalid_argument
// otherwise.
SystematicAndRandom systematic_and_random(std::span<const surface::HeightMap> deviations);

} // namespace vkfv::topography
