#include "dimensions/correlated_errors.hpp"

#include "core/mathematics/fourier.hpp"
#include "dimensions/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace vkfv::dimensions {
namespace {

struct Correlations {
    std::vector<double> along_x, along_y; // at distances of 0, 1, ... points

    // The number of points that together carry the information of one independent value.
    double points() const { return correlated_length(along_x) * correlated_length(along_y); }
};

// The matrix F'RF, n x n, of fit_covariance().
std::vector<double> correlated_products(const Grid<double>& residues, std::size_t n, const FitFunctions& functions,
                                        const Correlations& correlations) {
    std::vector<double> products(n * n), values(n);
    for (std::size_t first = 0; first < n; first += 2) {
        const std::size_t second = std::min(first + 1, n - 1);
        Grid<std::complex<double>> spread(residues.columns, residues.rows);
        for (std::size_t place = 0; place < residues.values.size(); ++place) {
            if (std::isfinite(residues.values[place])) {
                functions(place, values);
                spread.values[place] = {values[first], values[second]};
            }
        }
        convolve(spread, correlations.along_x, correlations.along_y);
        for (std::size_t place = 0; place < residues.values.size(); ++place) {
            if (std::isfinite(residues.values[place])) {
                functions(place, values);
                for (std::size_t k = 0; k < n; ++k) {
                    products[k * n + first] += values[k] * spread.values[place].real();
                    if (second != first) {
                        products[k * n + second] += values[k] * spread.values[place].imag();
                    }
                }
            }
        }
    }
    return products;
}

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b, std::size_t n) {
    std::vector<double> result(n * n);
    for (std::size_t row = 0; row < n; ++row) {
        for (std::size_t k = 0; k < n; ++k) {
            for (std::size_t column = 0; column < n; ++column) {
                result[row * n + column] += a[row * n + k] * b[k * n + column];
            }
        }
    }
    return result;
}

double trace(const std::vector<double>& matrix, std::size_t n) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
        sum += matrix[k * n + k];
    }
    return sum;
}

} // namespace

double student_factor(double degrees) {
    const double nu = std::max(1.0, degrees);
    return 2 * nu / (2 * nu - 1);
}

double FitCovariance::standard_error(std::span<const double> weights) const {
    double variance = 0, least = 0;
    for (std::size_t row = 0; row < n_; ++row) {
        for (std::size_t column = 0; column < n_; ++column) {
            variance += weights[row] * weights[column] * values_[row * n_ + column];
            least += weights[row] * weights[column] * least_[row * n_ + column];
        }
    }
    return std::sqrt(std::max(variance, least));
}

double FitCovariance::standard_error(std::size_t unknown) const {
    std::vector<double> weights(n_);
    weights[unknown] = 1;
    return standard_error(weights);
}

FitCovariance fit_covariance(const Grid<double>& residues, const LeastSquares::Solution& solution,
                             const FitFunctions& functions, double taken) {
    constexpr double least_share = 0.1, worth_giving_back = 0.01;
    const std::size_t n = solution.unknowns.size();
    double squares = 0, points = 0;
    for (const double residue : residues.values) {
        if (std::isfinite(residue)) {
            squares += residue * residue;
            points += 1;
        }
    }
    Correlations correlations{.along_x = correlation_along_x(residues), .along_y = correlation_along_y(residues)};
    std::vector<double> spread =
        product(solution.inverse, correlated_products(residues, n, functions, correlations), n);
    // Each mean of lagged products lacks the share that the fit has removed from the residues, which is the same at all
    // distances.
    const double taken_share = (trace(spread, n) + taken) / points;
    const double lags =
        static_cast<double>((2 * correlations.along_x.size() - 1) * (2 * correlations.along_y.size() - 1));
    if (taken_share * lags > worth_giving_back * correlations.points()) {
        const double share = std::min(0.5, taken_share);
        for (auto* line : {&correlations.along_x, &correlations.along_y}) {
            for (double& rho : *line) {
                rho += share * (1 - rho);
            }
        }
        spread = product(solution.inverse, correlated_products(residues, n, functions, correlations), n);
    }
    const double left = points - trace(spread, n) - taken;
    if (!(left > 0)) {
        const std::vector<double> none(n * n, std::numeric_limits<double>::quiet_NaN());
        return {n, none, none};
    }
    const double factor = squares / left * std::pow(student_factor(left / correlations.points()), 2);
    std::vector<double> covariance = product(spread, solution.inverse, n), least = solution.inverse;
    for (double& value : covariance) {
        value *= factor;
    }
    for (double& value : least) {
        value *= least_share * factor;
    }
    return {n, std::move(covariance), std::move(least)};
}

} // namespace vkfv::dimensions
