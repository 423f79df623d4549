// Fits a smooth function of one variable by a quotient of polynomials.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace vkfv::specimen {

// The quotient (p0 + p1 x + ...) / (1 + q1 x + ...).
struct RationalFit {
    std::vector<double> numerator;   // p0, p1, ...
    std::vector<double> denominator; // 1, q1, ...
    double error = 0;                // largest error at the points, relative, evaluated in float
};

// Fits the positive values f at the points x > 0 with least relative squares. The problem is linearised and weighted
// anew with the last denominator: C. K. Sanathanan, J. Koerner, IEEE Trans. Autom. Control 8 (1963) 56. The result is
// the fit of the lowest degree whose error in float is within the wanted one, else the best up to the highest: a degree
// too many brings nearly cancelling roots, which may lie between two points. The denominator's degree is one less.
RationalFit fit_rational(const std::vector<double>& x, const std::vector<double>& f, std::size_t highest_degree,
                         double wanted_error);

// Fits a function that is 0 at t = 0, over t in [0, 1], by t (p0 + p1 z + ...) / (1 + q1 z + ...), z = 2 t - 1, both
// polynomials of the same degree. The iteration is that of fit_rational(), with weights that equalize the error and
// make it count a little more where f is small. RationalFit::error is the largest absolute error in float, also between
// the points; of the degrees from 5 to the highest the one with the least error is taken.
RationalFit fit_rational_from_zero(const std::function<double(double)>& f, std::size_t highest_degree);

} // namespace vkfv::specimen
