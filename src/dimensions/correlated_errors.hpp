// How well a least-squares fit knows its unknowns when the errors of neighbouring points are alike.
#pragma once

#include "core/mathematics/grid.hpp"
#include "dimensions/least_squares.hpp"

#include <functional>
#include <span>
#include <vector>

namespace vkfv::dimensions {

// Covariance of the unknowns, n x n, in the units of the unknowns; NaN where the points do not tell it.
class FitCovariance {
  public:
    // least: of independent errors so much smaller that no variance is below it.
    FitCovariance(std::size_t unknowns, std::vector<double> values, std::vector<double> least)
        : n_(unknowns), values_(std::move(values)), least_(std::move(least)) {}

    // Standard error of the sum of weights times unknowns.
    double standard_error(std::span<const double> weights) const;
    double standard_error(std::size_t unknown) const;

  private:
    std::size_t n_;
    std::vector<double> values_, least_;
};

// The fit's functions at a point, whose place is its index in the grid; one for each unknown.
using FitFunctions = std::function<void(std::size_t place, std::span<double> values)>;

// residues: of the fitted points, NaN elsewhere. If F holds the functions at all points and R the correlation of the
// points' errors, the covariance is s^2 (F'F)^-1 F'RF (F'F)^-1, with s^2 the sum of squares over the number of points
// less tr((F'F)^-1 F'RF): so many of them the fit has taken. R is the product of the residues' correlation along rows
// and along columns, each up to the first distance at which it is not positive; what the fit has taken of it is given
// back: E. Parzen, "On consistent estimates of the spectrum", 1957, has the means of lagged products, P. Bloomfield,
// "Fourier Analysis of Time Series", 9, that a wave meets the errors' spectrum at its own frequency alone. `taken`:
// parameters besides the unknowns that were taken off the residues. The standard errors cover 68.27 % of
// Student's distribution for the degrees of freedom that are left (JCGM 100, G.3). A variance is at least a tenth
// of that of independent errors.
FitCovariance fit_covariance(const Grid<double>& residues, const LeastSquares::Solution& solution,
                             const FitFunctions& functions, double taken = 0);

// The factor by which a standard error grows since its variance was found with few degrees of freedom: the quantile of
// Student's distribution within which 68.27 % lie, 2 nu / (2 nu - 1) to one in a hundred from nu = 2 on; nu no less
// than 1.
double student_factor(double degrees);

} // namespace vkfv::dimensions
