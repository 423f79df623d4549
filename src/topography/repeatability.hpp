// What of the deviation every repetition has in common, and what is its own.
#pragma once

#include "surface/height_map.hpp"

#include <span>

namespace vkfv::topography {

// A model of n repetitions: deviation = systematic(point) + random(point, repetition), the random part of mean zero,
// independent between repetitions (not between points). mm.
struct SystematicAndRandom {
    // Mean square of the mean deviations, less random^2 / n, which their own scatter adds: free of bias, and its root
    // is given (0 where the difference is negative).
    double systematic = 0;
    // Root of the sum of squared residuals over their degrees of freedom, n - 1 a point.
    double random = 0;
    // By the jackknife over repetitions (Efron 1982), which needs no independence of points; NaN below three.
    double systematic_error = 0;
    double random_error = 0;
    double points = 0;                     // that two or more repetitions measured; the others do not count
    surface::HeightMap mean_deviation;     // mm; NaN at the points that do not count
    surface::HeightMap standard_deviation; // of one repetition, mm; likewise
};

// Deviations (measured less true) of repetitions on one grid, two or more: std::invalid_argument otherwise.
SystematicAndRandom systematic_and_random(std::span<const surface::HeightMap> deviations);

} // namespace vkfv::topography
