#include "dimensions/statistics.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::dimensions {
namespace {

// Sum over pairs `lag` apart of the products about the mean, in lines of `length` points `stride` apart.
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

    // 1 + 2 sum of rho_k; lags of more than a quarter of the length tell nothing.
    double sum() const {
        const double variance = at(0);
        double total = 1;
        if (variance > 0)
            for (std::size_t lag = 1; lag <= length / 4; ++lag) {
                const double rho = at(lag) / variance;
                if (!(rho > 0))
                    break;
                total += 2 * rho;
            }
        return total;
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
    result.standard_error = result.standard_deviation * std::sqrt(std::min(correlation.sum(), count) / count);
    return result;
}

double correlated_points(const Grid<double>& residues) {
    double count = 0;
    const double mean = mean_of_finite(residues.values, count);
    const auto columns = static_cast<std::size_t>(residues.columns), rows = static_cast<std::size_t>(residues.rows);
    const Correlation along_x{residues.values, rows, columns, columns, 1, mean};
    const Correlation along_y{residues.values, columns, 1, rows, columns, mean};
    return along_x.sum() * along_y.sum();
}

} // namespace vkfv::dimensions
