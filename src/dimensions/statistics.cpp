#include "dimensions/statistics.hpp"

#include "dimensions/correlated_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vkfv::dimensions {
namespace {

// The autocovariance of values in lines of `length` points `stride` apart: at() is the mean product of deviations over
// pairs `lag` apart.
struct Correlation {
    const std::vector<double>& values;
    std::size_t lines, line_stride, length, stride;
    double mean;

    double at(std::size_t lag) const {
        double sum = 0, pairs = 0;
        for (std::size_t line = 0; line < lines; ++line)
            for (std::size_t k = 0; k + lag < length; ++k) {
                const double a = values[line * line_stride + k * stride];
                const double b = values[line * line_stride + (k + lag) * stride];
                if (std::isfinite(a) && std::isfinite(b)) {
                    sum += (a - mean) * (b - mean);
                    pairs += 1;
                }
            }
        return pairs > 0 ? sum / pairs : 0;
    }

    // The correlation at lags of 0, 1, ..., up to the first at which it is no larger than `errors` of its standard
    // errors by M. Bartlett's equation for `independent` values. Lags above a quarter of the length are not used, as
    // they have too few pairs.
    std::vector<double> positive(double independent, double errors) const {
        std::vector<double> correlation{1};
        const double variance = at(0);
        double squares = 1;
        for (std::size_t lag = 1; variance > 0 && lag <= length / 4; ++lag) {
            const double rho = at(lag) / variance;
            if (!(rho > errors * std::sqrt(squares / independent)))
                break;
            correlation.push_back(rho);
            squares += 2 * rho * rho;
        }
        return correlation;
    }
};

double mean_of_finite(const std::vector<double>& values, double& count) {
    double sum = 0;
    count = 0;
    for (const double value : values)
        if (std::isfinite(value)) {
            sum += value;
            count += 1;
        }
    return sum / count;
}

} // namespace

Mean mean_of(const std::vector<double>& in_order) {
    double count = 0;
    Mean result{.mean = mean_of_finite(in_order, count)};
    result.count = static_cast<int>(count);
    if (result.count < 2)
        return result;
    double squares = 0;
    for (const double value : in_order)
        if (std::isfinite(value))
            squares += (value - result.mean) * (value - result.mean);
    result.standard_deviation = std::sqrt(squares / (count - 1));
    const Correlation correlation{in_order, 1, 0, in_order.size(), 1, result.mean};
    const double together = correlated_length(correlation.positive(count, 1));
    const double share = std::min(together / count, 0.5);
    result.standard_error =
        result.standard_deviation * std::sqrt(share / (1 - share)) * student_factor((1 - share) / share);
    return result;
}

double correlated_length(const std::vector<double>& correlation) {
    return 2 * std::accumulate(correlation.begin(), correlation.end(), 0.0) - correlation.front();
}

std::vector<double> correlation_along_x(const Grid<double>& residues) {
    double count = 0;
    const double mean = mean_of_finite(residues.values, count);
    const auto columns = static_cast<std::size_t>(residues.columns), rows = static_cast<std::size_t>(residues.rows);
    return Correlation{residues.values, rows, columns, columns, 1, mean}.positive(count, 0);
}

std::vector<double> correlation_along_y(const Grid<double>& residues) {
    double count = 0;
    const double mean = mean_of_finite(residues.values, count);
    const auto columns = static_cast<std::size_t>(residues.columns), rows = static_cast<std::size_t>(residues.rows);
    return Correlation{residues.values, columns, 1, rows, columns, mean}.positive(count, 0);
}

} // namespace vkfv::dimensions
