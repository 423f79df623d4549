#include "optics/waves/quadrature.hpp"

#include "core/mathematics/units.hpp"

#include <cmath>

namespace vkfv::optics {

// The roots of Legendre's polynomial by Newton's method, which converges from this guess (Abramowitz and Stegun,
// section 22.16.6); weights 2 / ((1 - x^2) P'(x)^2) (25.4.29).
std::vector<QuadratureNode> gauss_legendre(int count, double from, double to) {
    std::vector<QuadratureNode> nodes;
    for (int k = 0; k < count; ++k) {
        double x = -std::cos(pi * (k + 0.75) / (count + 0.5));
        double slope = 1;
        double last = 1;
        for (int step = 0; step < 8 && std::abs(last) > 1e-15; ++step) {
            double before = 0;
            double value = 1;
            for (int n = 1; n <= count; ++n) {
                const double next = ((2 * n - 1) * x * value - (n - 1) * before) / n;
                before = value;
                value = next;
            }
            slope = count * (before - x * value) / ((1 - x) * (1 + x));
            last = value / slope;
            x -= last;
        }
        const double half = 0.5 * (to - from);
        nodes.push_back({.place = from + half * (1 + x), .weight = half * 2 / ((1 - x) * (1 + x) * slope * slope)});
    }
    return nodes;
}

} // namespace vkfv::optics
