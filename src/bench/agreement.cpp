#include "bench/agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vkfv::bench {

namespace {

// The upper tail of chi-square: E. B. Wilson, M. M. Hilferty, "The distribution of chi-square", PNAS 17 (1931) 684.
double chi_square_tail(double chi_square, double degrees) {
    const double variance = 2.0 / (9.0 * degrees);
    return 0.5 * std::erfc((std::cbrt(chi_square / degrees) - 1.0 + variance) / std::sqrt(2.0 * variance));
}

// The variance for each unit of the value, over the whole image.
double variance_rate(const Measured& image) {
    const auto total = [](const Grid<double>& grid) {
        return std::accumulate(grid.values.begin(), grid.values.end(), 0.0);
    };
    return total(image.variance) / std::max(total(image.value), std::numeric_limits<double>::min());
}

} // namespace

Measured measured_counts(const Grid<double>& flux, double per_ray) {
    Measured result{flux, flux};
    std::ranges::transform(flux.values, result.variance.values.begin(), [&](double watts) { return watts * per_ray; });
    return result;
}

Agreement compare(const Measured& a, const Measured& b) {
    Agreement result;
    double total = 0, total_variance = 0;
    const double rate_a = variance_rate(a), rate_b = variance_rate(b);
    if (!(rate_a + rate_b > 0)) {
        return result;
    }
    const int columns = a.value.columns, rows = a.value.rows;
    for (int first_row = 0; first_row < rows; first_row += block_side) {
        for (int first_column = 0; first_column < columns; first_column += block_side) {
            double of_a = 0, of_b = 0;
            for (int row = first_row; row < std::min(first_row + block_side, rows); ++row) {
                for (int column = first_column; column < std::min(first_column + block_side, columns); ++column) {
                    const auto k = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                                   static_cast<std::size_t>(column);
                    of_a += a.value.values[k];
                    of_b += b.value.values[k];
                }
            }
            const double difference = of_a - of_b;
            // Each image is weighted with the other's rate, which gives the best mean of both.
            const double variance = of_a * rate_b + of_b * rate_a;
            total += difference;
            total_variance += variance;
            if (variance > 0) {
                result.chi_square += difference * difference / variance;
                result.degrees += 1;
            }
        }
    }
    if (result.degrees > 0) {
        result.total_z = total / std::sqrt(total_variance);
        // The smaller p-value of the two tests is taken, with Sidak's correction.
        const double smaller = std::min(std::erfc(std::abs(result.total_z) / std::sqrt(2.0)),
                                        chi_square_tail(result.chi_square, result.degrees));
        result.p = 1.0 - (1.0 - smaller) * (1.0 - smaller);
    }
    return result;
}

} // namespace vkfv::bench
