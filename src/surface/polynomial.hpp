// Form removal by a polynomial of two variables.
#pragma once

#include "surface/height_map.hpp"

#include <vector>

namespace vkfv::surface {

// A sum of all x^i y^j with i + j <= degree, represented by products of Legendre polynomials over the extent of the
// measured points, which keep the fit well conditioned.
struct Polynomial {
    int degree = 0;
    double x_centre = 0;
    double y_centre = 0;
    double half_x = 1; // mm from the centre to the outermost points
    double half_y = 1;
    std::vector<double> coefficients; // mm, of P_i(u) P_j(v), j ascending within i ascending

    double height(double x, double y) const;
};

// The least-squares polynomial along z over the measured points, by orthogonal transformations of the equations of a
// row, then of all rows (1000 x 1000 points: degree 6 in 0.1 s, degree 20 in 0.3 s); degree 0 to 20,
// std::invalid_argument otherwise. If the points leave coefficients undetermined (points on one line, fewer points than
// terms), the solution of the smallest norm is taken. Without measured points the heights are NaN.
Polynomial least_squares_polynomial(const HeightMap& map, int degree);

HeightMap remove_polynomial(HeightMap map, const Polynomial& polynomial);

} // namespace vkfv::surface
