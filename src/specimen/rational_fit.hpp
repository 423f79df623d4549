// A smooth function of one variable as a quotient of polynomials.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace vkfv::specimen {

// (p0 + p1 x + ...) / (1 + q1 x + ...)
struct RationalFit {
    std::vector<double> numerator;   // p0, p1, ...
    std::vector<double> denominator; // 1, q1, ...
    double error = 0;                // the largest at the points, relative, as evaluated in float
};

// Through the positive values f at the points x > 0, in the sense of least relative squares: linearised, and weighted
// anew with the last denominator, C. K. Sanathanan, J. Koerner, IEEE Trans. Autom. Control 8 (1963) 56. The fit of the
// lowest degree that evaluates in float with no more than the wanted error, or else the best up to the highest: a
// degree more than is needed brings nearly cancelling roots, which may lie between two points. The denominator's degree
// is one less.
RationalFit fit_rational(const std::vector<double>& x, const std::vector<double>& f, std::size_t highest_degree,
                         double wanted_error);

// Fits a function that is 0 at t = 0, over t in [0, 1], by t (p0 + p1 z + ...) / (1 + q1 z + ...), z = 2 t - 1, both of
// the same degree. The same iteration with weights that even out the error, which counts a little more where f is
// small. RationalFit::error is the largest, absolute, as evaluated in float, between the points too: that of the fit of
// 5 to the highest degree that has the least.
RationalFit fit_rational_from_zero(const std::function<double(double)>& f, std::size_t highest_degree);

} // namespace vkfv::specimen
