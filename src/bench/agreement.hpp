// Tests whether two images that were made with independent random numbers have the same expected value.
#pragma once

#include "core/mathematics/grid.hpp"

#include <cstdint>

namespace vkfv::bench {

// An image with the variance of each pixel; any unit.
struct Measured {
    Grid<double> value;
    Grid<double> variance;
};

// Counts of rays, Poisson, each of the same weight.
Measured measured_counts(const Grid<double>& flux, double per_ray);

struct Agreement {
    double total_z = 0;    // difference of the totals in standard errors
    double chi_square = 0; // of the differences of blocks of block_side x block_side pixels
    int degrees = 0;       // blocks that hold anything
    double p = 1;          // probability of a larger difference if both have the same expected value

    // false_alarms: probability of calling two images different that have the same expected value.
    bool holds(double false_alarms) const { return p >= false_alarms; }
};
inline constexpr int block_side = 8;

// A block's variance is taken from the mean of both images, each image's as its light is shared out: a count's own
// would be small where the count happens to be. Two Poisson counts with one expectation then give a chi-square of mean
// 1 exactly, whatever their numbers of rays.
Agreement compare(const Measured& a, const Measured& b);

} // namespace vkfv::bench
