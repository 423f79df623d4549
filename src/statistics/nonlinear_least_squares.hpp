// Least squares of residuals that are not linear in their unknowns, by the algorithm of Levenberg and Marquardt (More's
// in MINPACK, as Eigen has it).
#pragma once

#include "statistics/matrix.hpp"

#include <functional>
#include <vector>

namespace vkfv::statistics {

// Residuals and their derivatives, a row a residual and a column an unknown. There are at least as many residuals as
// unknowns. What they throw ends the search.
struct Residuals {
    std::function<std::vector<double>(const std::vector<double>& unknowns)> values;
    std::function<Matrix(const std::vector<double>& unknowns)> slopes;
};

struct LeastSquaresEnd {
    std::vector<double> unknowns{};
    int evaluations = 0;    // of the residuals
    bool converged = false; // false: the evaluations were used up, or no further step lowers the sum
};

// Searches from the start until the sum of squares, or the unknowns, change by less than the tolerance, relative to
// their size. Throws std::invalid_argument for fewer residuals than unknowns.
LeastSquaresEnd nonlinear_least_squares(const Residuals& residuals, std::vector<double> start, double tolerance,
                                        int most_evaluations);

} // namespace vkfv::statistics
