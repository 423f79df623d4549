// Means of numbers that follow each other, and how well these are known.
#pragma once

#include "surface/height_map.hpp"

#include <vector>

namespace vkfv::dimensions {

// NaN where there are too few numbers.
struct Mean {
    double mean = surface::undefined;
    double standard_deviation = surface::undefined; // of one of them
    double standard_error = surface::undefined;     // of the mean
    int count = 0;
};

// Neighbours may be correlated, as profiles of a window's width are: the standard error is s / sqrt(n) times
// sqrt(1 + 2 sum of rho_k), rho_k the correlation at a distance of k, up to the first that is not positive (G. Box,
// G. Jenkins, G. Reinsel, "Time Series Analysis", 2.1). NaN among the numbers are gaps.
Mean mean_of(const std::vector<double>& in_order);

// As many neighbouring points of these residues carry one independent value: the same sum, along rows times along
// columns; at least 1.
double correlated_points(const Grid<double>& residues);

} // namespace vkfv::dimensions
