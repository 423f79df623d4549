// Means of numbers in a sequence, and their standard errors.
#pragma once

#include "surface/height_map.hpp"

#include <vector>

namespace vkfv::dimensions {

// A mean of numbers and its scatter; NaN if there are too few numbers.
struct Mean {
    double mean = surface::undefined;
    double standard_deviation = surface::undefined; // scatter of a single number
    double standard_error = surface::undefined;     // standard error of the mean
    int count = 0;
};

// The mean of numbers in sequence whose neighbours may be correlated, as profiles within the width of a window are.
// With rho_k the correlation at a distance of k, up to the first that is no larger than its standard error (M.
// Bartlett's equation), tau = 1 + 2 sum of rho_k numbers carry the information of one independent value (G. Box, G.
// Jenkins, G. Reinsel, "Time Series Analysis", 2.1). The standard error is s sqrt(tau / (n - tau)), since the scatter
// about the mean lacks the mean's own, times the factor of Student's distribution with n / tau - 1 degrees of freedom
// (correlated_errors.hpp). NaN among the numbers are gaps.
Mean mean_of(const std::vector<double>& in_order);

// The correlation of residues at distances of 0 (where it is 1), 1, ... points along rows or along columns, up to the
// first distance at which it is not positive, at most a quarter of the map.
std::vector<double> correlation_along_x(const Grid<double>& residues);
std::vector<double> correlation_along_y(const Grid<double>& residues);

// The correlation length 1 + 2 sum of rho_k, in points.
double correlated_length(const std::vector<double>& correlation);

} // namespace vkfv::dimensions
