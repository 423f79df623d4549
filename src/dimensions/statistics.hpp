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

// Neighbours may be correlated, as profiles of a window's width are. With rho_k the correlation at a distance of k, up
// to the first that is no larger than its standard error (M. Bartlett's equation), tau = 1 + 2 sum of rho_k of them
// carry one independent value (G. Box, G. Jenkins, G. Reinsel, "Time Series Analysis", 2.1). The standard error is s
// sqrt(tau / (n - tau)), since the scatter about the mean lacks the mean's own, times the factor of
// Student's distribution with n / tau - 1 degrees of freedom (correlated_errors.hpp). NaN among the numbers are gaps.
Mean mean_of(const std::vector<double>& in_order);

// rho at distances of 0 (1), 1, ... points along rows and along columns, all that lie before the first that is not
// positive and within a quarter of the map.
std::vector<double> correlation_along_x(const Grid<double>& residues);
std::vector<double> correlation_along_y(const Grid<double>& residues);

// 1 + 2 sum of rho_k.
double correlated_length(const std::vector<double>& correlation);

} // namespace vkfv::dimensions
