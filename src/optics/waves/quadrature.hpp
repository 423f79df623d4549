// Gauss-Legendre quadrature.
#pragma once

#include <vector>

namespace vkfv::optics {

struct QuadratureNode {
    double place = 0;
    double weight = 0;
};

// Nodes and weights over [from, to]; the rule is exact for polynomials of degree 2 count - 1.
std::vector<QuadratureNode> gauss_legendre(int count, double from = -1, double to = 1);

} // namespace vkfv::optics
