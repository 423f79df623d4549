#include "specimen/rational_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vkfv::specimen {

namespace {

// The x that minimises |columns x - right|, by Householder's reflections.
std::vector<double> least_squares(std::vector<std::vector<double>> columns, std::vector<double> right) {
    const std::size_t n = columns.size(), rows = right.size();
    std::vector<double> scale(n), x(n);
    for (std::size_t k = 0; k < n; ++k) {
        double sum = 0;
        for (const double value : columns[k]) {
            sum += value * value;
        }
        scale[k] = std::sqrt(sum);
        for (double& value : columns[k]) {
            value /= scale[k];
        }
    }
    for (std::size_t k = 0; k < n; ++k) {
        std::vector<double> axis = columns[k];
        std::fill_n(axis.begin(), k, 0.0);
        double sum = 0;
        for (const double value : axis) {
            sum += value * value;
        }
        axis[k] += std::copysign(std::sqrt(sum), axis[k]);
        const double length_squared = 2 * std::sqrt(sum) * std::abs(axis[k]);
        const auto reflect = [&](std::vector<double>& vector) {
            double along = 0;
            for (std::size_t i = k; i < rows; ++i) {
                along += axis[i] * vector[i];
            }
            for (std::size_t i = k; i < rows; ++i) {
                vector[i] -= 2 * along / length_squared * axis[i];
            }
        };
        for (std::size_t column = k; column < n; ++column) {
            reflect(columns[column]);
        }
        reflect(right);
    }
    for (std::size_t k = n; k-- > 0;) {
        double value = right[k];
        for (std::size_t column = k + 1; column < n; ++column) {
            value -= columns[column][k] * x[column];
        }
        x[k] = value / columns[k][k];
    }
    for (std::size_t k = 0; k < n; ++k) {
        x[k] /= scale[k];
    }
    return x;
}

} // namespace

RationalFit fit_rational(const std::vector<double>& x, const std::vector<double>& f, std::size_t highest_degree,
                         double wanted_error) {
    const auto polynomial = [](const std::vector<double>& coefficients, float at) {
        float sum = 0;
        for (std::size_t k = coefficients.size(); k-- > 0;) {
            sum = sum * at + static_cast<float>(coefficients[k]);
        }
        return sum;
    };
    RationalFit best;
    best.error = std::numeric_limits<double>::infinity();
    constexpr int rounds = 10; // it has settled after four or five
    for (std::size_t degree = 2; degree <= highest_degree; ++degree) {
        std::vector<double> weights(x.size(), 1.0);
        for (int round = 0; round < rounds && best.error > wanted_error; ++round) {
            std::vector<std::vector<double>> columns(2 * degree, std::vector<double>(x.size()));
            for (std::size_t i = 0; i < x.size(); ++i) {
                double power = weights[i];
                for (std::size_t k = 0; k <= degree; ++k) {
                    columns[k][i] = power / f[i];
                    if (k > 0 && k < degree) {
                        columns[degree + k][i] = -power;
                    }
                    power *= x[i];
                }
            }
            const auto solution = least_squares(columns, weights);
            const auto middle = solution.begin() + static_cast<std::ptrdiff_t>(degree) + 1;
            RationalFit fit{{solution.begin(), middle}, {1.0}, 0};
            fit.denominator.insert(fit.denominator.end(), middle, solution.end());
            for (std::size_t i = 0; i < x.size(); ++i) {
                const auto at = static_cast<float>(x[i]);
                const double below = polynomial(fit.denominator, at);
                fit.error = std::max(fit.error, std::abs(polynomial(fit.numerator, at) / below / f[i] - 1));
                weights[i] = 1 / std::abs(below);
            }
            if (fit.error < best.error) {
                best = fit;
            }
        }
    }
    return best;
}

} // namespace vkfv::specimen
