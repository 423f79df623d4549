#include "specimen/rational_fit.hpp"

#include "core/mathematics/units.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vkfv::specimen {

namespace {

// The x that minimises |columns x - right|, by Householder reflections.
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

float polynomial(const std::vector<double>& coefficients, float at) {
    float sum = 0;
    for (std::size_t k = coefficients.size(); k-- > 0;) {
        sum = sum * at + static_cast<float>(coefficients[k]);
    }
    return sum;
}

struct Samples {
    std::vector<double> t, f;
};

// Samples f at Chebyshev's points (shift 0), or between them.
Samples sample(const std::function<double(double)>& f, int points, double shift) {
    Samples samples;
    for (int k = 0; k < points; ++k) {
        const double t = 0.5 - 0.5 * std::cos(pi * (k + shift) / points);
        samples.t.push_back(t);
        samples.f.push_back(f(t));
    }
    return samples;
}

// A fit t P / Q with P and Q of the given degree, linearised.
RationalFit linearised_from_zero(const Samples& at, const std::vector<double>& weights, std::size_t degree) {
    std::vector<std::vector<double>> columns(2 * degree + 1, std::vector<double>(at.t.size()));
    std::vector<double> right(at.t.size());
    for (std::size_t i = 0; i < at.t.size(); ++i) {
        double power = weights[i];
        for (std::size_t k = 0; k <= degree; ++k) {
            columns[k][i] = at.t[i] * power;
            if (k > 0) {
                columns[degree + k][i] = -at.f[i] * power;
            }
            power *= 2 * at.t[i] - 1;
        }
        right[i] = at.f[i] * weights[i];
    }
    const auto solution = least_squares(columns, right);
    const auto middle = solution.begin() + static_cast<std::ptrdiff_t>(degree) + 1;
    RationalFit fit{{solution.begin(), middle}, {1.0}, 0};
    fit.denominator.insert(fit.denominator.end(), middle, solution.end());
    return fit;
}

double from_zero(const RationalFit& fit, double t) {
    const auto place = static_cast<float>(t), z = 2 * place - 1;
    return static_cast<double>(place * polynomial(fit.numerator, z) / polynomial(fit.denominator, z));
}

} // namespace

RationalFit fit_rational_from_zero(const std::function<double(double)>& f, std::size_t highest_degree) {
    constexpr int points = 120;
    constexpr double softening = 0.3; // errors have the weight 1 / (f + softening)
    const Samples fitted = sample(f, points, 0.5), between = sample(f, 3 * points, 0.25);
    RationalFit best;
    best.error = std::numeric_limits<double>::infinity();
    constexpr int evenings = 8, rounds = 5; // more change nothing
    for (std::size_t degree = 5; degree <= highest_degree; ++degree) {
        std::vector<double> importance;
        for (const double value : fitted.f) {
            importance.push_back(1 / (value + softening));
        }
        const std::vector<double> counted = importance;
        for (int evening = 0; evening < evenings; ++evening) {
            RationalFit fit;
            std::vector<double> weights = importance;
            for (int round = 0; round < rounds; ++round) {
                fit = linearised_from_zero(fitted, weights, degree);
                for (std::size_t i = 0; i < weights.size(); ++i) {
                    const auto z = static_cast<float>(2 * fitted.t[i] - 1);
                    weights[i] = importance[i] / std::abs(static_cast<double>(polynomial(fit.denominator, z)));
                }
            }
            std::vector<double> errors;
            double largest = 0;
            for (std::size_t i = 0; i < fitted.t.size(); ++i) {
                errors.push_back(counted[i] * std::abs(from_zero(fit, fitted.t[i]) - fitted.f[i]));
                largest = std::max(largest, errors.back());
            }
            for (std::size_t i = 0; i < errors.size(); ++i) {
                importance[i] *= std::sqrt(errors[i] / largest + 0.05);
            }
            fit.error = 0;
            for (std::size_t i = 0; i < between.t.size(); ++i) {
                const double error = std::abs(from_zero(fit, between.t[i]) - between.f[i]);
                fit.error = error <= fit.error ? fit.error : error; // NaN counts as the largest error
            }
            if (fit.error < best.error) {
                best = fit;
            }
        }
    }
    return best;
}

RationalFit fit_rational(const std::vector<double>& x, const std::vector<double>& f, std::size_t highest_degree,
                         double wanted_error) {
    RationalFit best;
    best.error = std::numeric_limits<double>::infinity();
    constexpr int rounds = 10; // it converges after four or five
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
