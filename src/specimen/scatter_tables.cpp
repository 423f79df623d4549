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
    const double inside = (1 - magnitude) + magnitude * cosine * cosine / (1 + sine); // this is 1 - rho
    const double scale = std::hypot(inside, height);
    constexpr int panels = 48;
    constexpr double places[] = {-0.774596669241483377, 0, 0.774596669241483377}, weights[] = {5, 8, 5};
    const double half_panel = 0.5 * std::asinh(1 / scale) / panels;
    double sum = 0;
    for (int point = 0; point < 3 * panels; ++point) {
        const double t = half_panel * (2 * (point / 3) + 1 + places[point % 3]);
        const double mu = scale * std::sinh(t), d_mu = scale * std::cosh(t); // derivative by t
        const double s = std::sqrt(std::max(1 - mu * mu, 0.0));
        const double across = inside - mu * mu / (1 + s); // this is s - rho
        const double rise = (mu + height) * (mu + height);
        const double least = across * across + rise, most = (s + rho) * (s + rho) + rise;
        const double modulus = std::sqrt(std::max(1 - least / most, 0.0));
        sum += weights[point % 3] / 9 * d_mu * mu * std::comp_ellint_2(modulus) / (least * std::sqrt(most));
    }
    return std::max(g * cosine, 0.0) + (1 - magnitude) * (1 + magnitude) / pi * half_panel * sum;
}

namespace {

// The lobe with a fit of its norm over the cosine of incidence.
LobeRecord with_henyey_greenstein_norm(LobeRecord lobe) {
    const double g = lobe.parameter_0;
    if (g == 1) {
        return lobe;
    }
    // The distance of the norm's branch points; beyond 1 they have no effect.
    const double distance = std::abs(g) > 0.4 ? (1 - g) * (1 + g) / (2 * std::abs(g)) : 1.0;
    // The points are Chebyshev's in the variable over which N varies evenly.
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

// The lobe with the table that ggx_multiple_scatter_lack() evaluates, and with the bound of its proposals.
LobeRecord with_ggx_lack(LobeRecord lobe) {
    const double alpha = lobe.parameter_0;
    const double power = alpha >= 0.6 ? 4 : 2, scale = 2 * alpha;
    const auto lack = [&](double t) {
        const double y = std::pow(t, power) / (1 + scale);
        return 1 - ggx_kept(alpha, std::min(scale * y / (1 - y), 1.0));
    };
    const RationalFit fit = fit_rational_from_zero(lack, 7);
    std::ranges::fill(lobe.table, 0.0);
    std::ranges::copy(fit.numerator, lobe.table);
    std::copy(fit.denominator.begin() + 1, fit.denominator.end(), lobe.table + 8);
    // The mean is that of the fit, not of the function, so that exactly the lost light is returned. The cosine is s^3.
    constexpr int panels = 4000;
    double mean = 0, most = 0, most_flat = 0;
    for (int k = 0; k < panels; ++k) {
        const double s = (k + 0.5) / panels, cosine = s * s * s;
        const double value = physics::f64::ggx_multiple_scatter_lack(alpha, lobe.table, cosine);
        mean += 2 * cosine * value * 3 * s * s / panels;
        most = std::max(most, value);
        most_flat = std::max(most_flat, 2 * cosine * value);
    }
    for (int k = 0; k < 8; ++k) {
        lobe.table[k] /= std::sqrt(mean);
    }
    constexpr double margin = 1.01; // covers values between the points, and rounding in float
    const bool smooth_surface = physics::f64::ggx_multiple_scatter_is_smooth(alpha);
    lobe.table[15] = margin * (smooth_surface ? most_flat : most) / std::sqrt(mean);
    return lobe;
}

LobeRecord with_harvey_shack_scale(LobeRecord lobe) {
    const double shoulder = lobe.parameter_0, p = 1 + 0.5 * lobe.parameter_1;
    const double last = std::log1p(1 / (shoulder * shoulder));
    lobe.table[0] = 1 / (pi * shoulder * shoulder * (p == 0 ? last : std::expm1(p * last) / p));
    return lobe;
}

// The lobe with the factor A, from the integral of d / (B + d^g) over d up to 1, computed in y = -log(d).
LobeRecord with_abg_scale(LobeRecord lobe) {
    const double b = lobe.parameter_0, g = lobe.parameter_1;
    const double last = 20 - std::log(b) / g; // the tail beyond is below rounding
    const int panels = static_cast<int>(std::ceil(20 * last));
    const double half_panel = 0.5 * last / panels;
    constexpr double places[] = {-0.774596669241483377, 0, 0.774596669241483377}, weights[] = {5, 8, 5};
    double sum = 0;
    for (int point = 0; point < 3 * panels; ++point) {
        const double y = half_panel * (2 * (point / 3) + 1 + places[point % 3]);
        sum += weights[point % 3] / 9 * half_panel * std::exp(-2 * y) / (b + std::exp(-g * y));
    }
    lobe.table[0] = 1 / (2 * pi * sum);
    return lobe;
}

} // namespace

double ggx_kept(double alpha, double cosine) {
    const double incidence = std::acos(cosine), sine = std::sin(incidence);
    const double width = 0.5 * alpha * std::max(cosine, 1e-12); // width of the lobe, limited for grazing incidence
    const auto reach = [&](double c) { return std::sqrt(alpha * alpha + (1 - alpha) * (1 + alpha) * c * c); };
    constexpr int panels = 200;
    constexpr double places[] = {-0.774596669241483377, 0, 0.774596669241483377}, weights[] = {5, 8, 5};
    const double first = std::asinh(-incidence / width), last = std::asinh((pi / 2 - incidence) / width);
    const double half_panel = 0.5 * (last - first) / panels;
    double sum = 0;
    for (int point = 0; point < 3 * panels; ++point) {
        const double t = first + half_panel * (2 * (point / 3) + 1 + places[point % 3]);
        const double apart = width * std::sinh(t), theta = incidence + apart;
        const double c_o = std::cos(theta), s_o = std::sin(theta), up = cosine + c_o;
        const double sines_apart = 2 * std::cos(incidence + 0.5 * apart) * std::sin(0.5 * apart);
        const double spread = alpha * alpha * up * up;
        const double least = spread + sines_apart * sines_apart;  // c - b
        const double most = spread + (sine + s_o) * (sine + s_o); // c + b
        const double middle = 0.5 * (least + most), r = std::sqrt(least * most);
        const double d = (1 - alpha) * (1 + alpha) * up * up;
        const double shadowed = reach(cosine) * c_o + cosine * reach(c_o);
        const double value = alpha * alpha / shadowed * (1 + 2 * d / r + d * d * middle / (r * r * r));
        sum += weights[point % 3] / 9 * half_panel * width * std::cosh(t) * value * c_o * s_o;
    }
    return sum;
}

double total_scatter(double sq, double wavelength_um) {
    const double phase = 4 * pi * sq * um_per_mm / wavelength_um;
    return -std::expm1(-phase * phase);
}

LobeRecord tabulated(LobeRecord lobe) {
    using namespace physics::f64;
    switch (lobe.model) {
    case SCATTER_HENYEY_GREENSTEIN:
        return with_henyey_greenstein_norm(lobe);
    case SCATTER_GGX_MULTIPLE_SCATTER:
        return with_ggx_lack(lobe);
    case SCATTER_HARVEY_SHACK:
        return with_harvey_shack_scale(lobe);
    case SCATTER_ABG:
        return with_abg_scale(lobe);
    default:
        return lobe;
    }
}

} // namespace vkfv::specimen
