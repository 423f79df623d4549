// Standard errors of a least-squares fit whose points have correlated errors.
#pragma once

#include "core/mathematics/grid.hpp"
#include "dimensions/least_squares.hpp"

#include <functional>
#include <span>
#include <vector>

namespace vkfv::dimensions {

// The covariance of the unknowns, n x n, in their units; NaN if the points do not determine it.
class FitCovariance {
  public:
    // least: the covariance for independent errors, scaled down to the smallest variance allowed.
    FitCovariance(std::size_t unknowns, std::vector<double> values, std::vector<double> least)
        : n_(unknowns), values_(std::move(values)), least_(std::move(least)) {}

    // The standard error of the sum of weights times unknowns.
    double standard_error(std::span<const double> weights) const;
    double standard_error(std::size_t unknown) const;

  private:
    std::size_t n_;
    std::vector<double> values_, least_;
};

// The fit's functions at a point, one value for each unknown; `place` is the point's index in the grid.
using FitFunctions = std::function<void(std::size_t place, std::span<double> values)>;

// The covariance of a fit. residues: of the fitted points, NaN elsewhere. If F holds the functions at all points and R
// the correlation of the points' errors, the covariance is s^2 (F'F)^-1 F'RF (F'F)^-1, where s^2 is the sum of squares
// over the number of points minus tr((F'F)^-1 F'RF), the degrees of freedom that the fit uses. R is the product of the
// residues' correlation along rows and along columns, each up to the first distance at which it is not positive,
// corrected for the part that the fit removed: E. Parzen, "On consistent estimates of the spectrum", 1957, gives the
// means of lagged products; P. Bloomfield, "Fourier Analysis of Time Series", 9, shows that a wave meets the errors'
// spectrum at its own frequency alone. `taken`: the number of parameters besides the unknowns that were removed from
// the residues. The standard errors cover 68.27 % of Student's distribution for the remaining degrees of freedom (JCGM
// 100, G.3). A variance is at least a tenth of that of independent errors.
FitCovariance fit_covariance(const Grid<double>& residues, const LeastSquares::Solution& solution,
                             const FitFunctions& functions, double taken = 0);

// The factor on a standard error whose variance has few degrees of freedom: the quantile of Student's distribution that
// covers 68.27 %, as 2 nu / (2 nu - 1), accurate to one in a hundred from nu = 2 on; nu is at least 1.
double student_factor(double degrees);

} // namespace vkfv::dimensions
