#include "specimen/scatter_tables.hpp"

#include "core/mathematics/units.hpp"
#include "specimen/rational_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vkfv::specimen {

using physics::f64::henyey_greenstein_place;
using LobeRecord = physics::f64::Lobe;

double henyey_greenstein_exact_norm(double g, double cosine) {
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
    const double magnitude = std::abs(g), height = magnitude * cosine, rho = magnitude * sine;
    const double inside = (1 - magnitude) + magnitude * cosine * cosine / (1 + sine); // 1 - rho
    const double scale = std::hypot(inside, height);
    constexpr int panels = 48;
    constexpr double places[] = {-0.774596669241483377, 0, 0.774596669241483377}, weights[] = {5, 8, 5};
    const double half_panel = 0.5 * std::asinh(1 / scale) / panels;
    double sum = 0;
    for (int point = 0; point < 3 * panels; ++point) {
        const double t = half_panel * (2 * (point / 3) + 1 + places[point % 3]);
        const double mu = scale * std::sinh(t), d_mu = scale * std::cosh(t); // over dt
        const double s = std::sqrt(std::max(1 - mu * mu, 0.0));
        const double across = inside - mu * mu / (1 + s); // s - rho
        const double rise = (mu + height) * (mu + height);
        const double least = across * across + rise, most = (s + rho) * (s + rho) + rise;
        const double modulus = std::sqrt(std::max(1 - least / most, 0.0));
        sum += weights[point % 3] / 9 * d_mu * mu * std::comp_ellint_2(modulus) / (least * std::sqrt(most));
    }
    return std::max(g * cosine, 0.0) + (1 - magnitude) * (1 + magnitude) / pi * half_panel * sum;
}

namespace {

// The norm over the cosine, fitted.
LobeRecord with_henyey_greenstein_norm(LobeRecord lobe) {
    const double g = lobe.parameter_0;
    if (g == 1) {
        return lobe;
    }
    // Farther branch points than 1 do not matter.
    const double distance = std::abs(g) > 0.4 ? (1 - g) * (1 + g) / (2 * std::abs(g)) : 1.0;
    // Chebyshev's points in the variable over which N changes evenly.
    constexpr int points = 100;
    std::vector<double> x, quotient;
    for (int k = 0; k < points; ++k) {
        const double place = 0.5 + 0.5 * std::cos(pi * (k + 0.5) / points);
        const double cosine = std::min(distance * std::sinh(place * std::asinh(1 / distance)), 1.0);
        const auto at = henyey_greenstein_place(g, distance * distance, cosine);
        x.push_back(at.x);
        quotient.push_back(henyey_greenstein_exact_norm(g, cosine) - at.linear);
    }
    const RationalFit fit = fit_rational(x, quotient, 6, 5e-7);
    for (std::size_t k = 0; k < fit.numerator.size(); ++k) {
        lobe.table[k] = fit.numerator[k];
    }
    for (std::size_t k = 1; k < fit.denominator.size(); ++k) {
        lobe.table[6 + k] = fit.denominator[k];
    }
    lobe.table[12] = distance * distance;
    return lobe;
}

} // namespace

LobeRecord tabulated(LobeRecord lobe) {
    return lobe.model == physics::f64::SCATTER_HENYEY_GREENSTEIN ? with_henyey_greenstein_norm(lobe) : lobe;
}

} // namespace vkfv::specimen
