// Tests whether two images with independent random numbers have the same expected value.
#pragma once

#include "core/mathematics/grid.hpp"

#include <cstdint>

namespace vkfv::bench {

// An image with the variance of each pixel; any unit.
struct Measured {
    Grid<double> value;
    Grid<double> variance;
};

// An image of ray counts, which are Poisson and have the same weight.
Measured measured_counts(const Grid<double>& flux, double per_ray);

struct Agreement {
    double total_z = 0;    // difference of the totals in standard errors
    double chi_square = 0; // chi-square of the differences between blocks of block_side x block_side pixels
    int degrees = 0;       // blocks that are not empty
    double p = 1;          // probability of a larger difference if both have the same expected value

    // false_alarms: probability of calling two images different that have the same expected value.
    bool holds(double false_alarms) const { return p >= false_alarms; }
};
inline constexpr int block_side = 8;

// Compares blocks and totals. A block's variance is taken from the mean of both images, shared out by each image's
// rate: a count's own variance would be small where the count happens to be small. Two Poisson counts with one
// expectation then give a chi-square of mean 1 exactly, whatever their numbers of rays.
Agreement compare(const Measured& a, const Measured& b);

} // namespace vkfv::bench
