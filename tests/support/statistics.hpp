// Statistical tests with a stated false-positive rate.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

namespace vkfv::test {

// Upper tail of the chi-square distribution by Wilson and Hilferty's cube-root approximation (1931); within 2 % of the
// true tail for 10 and more degrees of freedom at the levels used here.
inline double chi_square_tail(double chi_square, double degrees) {
    const double spread = 2.0 / (9.0 * degrees);
    const double z = (std::cbrt(chi_square / degrees) - (1.0 - spread)) / std::sqrt(spread);
    return 0.5 * std::erfc(z / std::sqrt(2.0));
}

// Pearson's test of counts against expected counts (cells below 5 expected are pooled with their successors).
inline double chi_square_p(const std::vector<double>& observed, const std::vector<double>& expected) {
    double chi_square = 0;
    double degrees = -1;
    double seen = 0;
    double wanted = 0;
    for (std::size_t cell = 0; cell < observed.size(); ++cell) {
        seen += observed[cell];
        wanted += expected[cell];
        if (wanted >= 5.0 || cell + 1 == observed.size()) {
            if (wanted > 0) {
                chi_square += (seen - wanted) * (seen - wanted) / wanted;
                degrees += 1;
            }
            seen = wanted = 0;
        }
    }
    return chi_square_tail(chi_square, degrees);
}

// Significance of each of n tests that together err with the probability `level` (Sidak 1967).
inline double sidak(double level, int tests) {
    return 1.0 - std::pow(1.0 - level, 1.0 / tests);
}

// |z| of a share seen in n draws.
inline double share_z(double seen, double n, double expected_share) {
    return std::abs(seen / n - expected_share) / std::sqrt(expected_share * (1.0 - expected_share) / n);
}

// Composite Simpson rule over [a, b] with 2 n panels.
template <class Function>
double integrate(Function f, double a, double b, int n = 500) {
    const double h = (b - a) / (2 * n);
    double sum = f(a) + f(b);
    for (int i = 1; i < 2 * n; ++i) {
        sum += f(a + i * h) * (i % 2 == 1 ? 4.0 : 2.0);
    }
    return sum * h / 3.0;
}

} // namespace vkfv::test
