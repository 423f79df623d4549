#include "topography/uncertainty/local_quadric.hpp"

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <utility>

namespace vkfv::topography {
namespace {

// Powers of x and y in each term.
constexpr std::array<std::pair<std::size_t, std::size_t>, 6> degrees = {
    std::pair{0, 0}, std::pair{1, 0}, std::pair{0, 1}, std::pair{2, 0}, std::pair{1, 1}, std::pair{0, 2}};

} // namespace

QuadricRow::QuadricRow(const Grid<double>& height, std::span<const double> weights)
    : height_(height), weights_(weights), columns_(static_cast<std::size_t>(height.columns)) {
    const int reach = static_cast<int>(weights.size()) - 1;
    std::array<double, powers> along{};
    for (int d = -reach; d <= reach; ++d) {
        double power = weights[static_cast<std::size_t>(std::abs(d))];
        for (double& sum : along) {
            sum += power;
            power *= distance(d);
        }
    }
    std::array<std::array<double, powers>, powers> moments{};
    for (std::size_t p = 0; p < powers; ++p) {
        for (std::size_t q = 0; q < powers; ++q) {
            moments[p][q] = along[p] * along[q];
        }
    }
    whole_ = moments[0][0];
    of_whole_ = factors_of(moments);
}

QuadricRow::Terms QuadricRow::factors_of(const std::array<std::array<double, powers>, powers>& moments) {
    // Cholesky's decomposition of the normal equations, whose right side is the first unit vector.
    constexpr double least = 1e-6; // least share of a diagonal element: heights along a line determine no surface
    std::array<Terms, terms> lower{};
    for (std::size_t i = 0; i < terms; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = moments[degrees[i].first + degrees[j].first][degrees[i].second + degrees[j].second];
            const double diagonal = sum;
            for (std::size_t k = 0; k < j; ++k) {
                sum -= lower[i][k] * lower[j][k];
            }
            if (i != j) {
                lower[i][j] = sum / lower[j][j];
            } else if (sum > least * diagonal) {
                lower[i][i] = std::sqrt(sum);
            } else {
                Terms none{};
                none.fill(std::numeric_limits<double>::quiet_NaN());
                return none;
            }
        }
    }
    Terms result{};
    for (std::size_t i = 0; i < terms; ++i) {
        double sum = i == 0 ? 1 : 0;
        for (std::size_t k = 0; k < i; ++k) {
            sum -= lower[i][k] * result[k];
        }
        result[i] = sum / lower[i][i];
    }
    for (std::size_t i = terms; i-- > 0;) {
        double sum = result[i];
        for (std::size_t k = i + 1; k < terms; ++k) {
            sum -= lower[k][i] * result[k];
        }
        result[i] = sum / lower[i][i];
    }
    return result;
}

QuadricRow::Whole QuadricRow::whole() const {
    return {.constant = of_whole_[0], .square = of_whole_[3] * distance(1) * distance(1)};
}

void QuadricRow::move_to(int row) {
    row_ = row;
    const int reach = static_cast<int>(weights_.size()) - 1;
    if (row < reach || row + reach >= height_.rows) {
        return;
    }
    for (int column = 0; column < height_.columns; ++column) {
        Column sums;
        for (int d = -reach; d <= reach; ++d) {
            const double z = height_(column, row + d);
            if (std::isfinite(z)) {
                const double y = distance(d), weight = weights_[static_cast<std::size_t>(std::abs(d))];
                sums.weight[0] += weight;
                sums.weight[1] += weight * y;
                sums.weight[2] += weight * y * y;
                sums.weight[3] += weight * y * y * y;
                sums.weight[4] += weight * y * y * y * y;
                sums.height[0] += weight * z;
                sums.height[1] += weight * z * y;
                sums.height[2] += weight * z * y * y;
            }
        }
        columns_[static_cast<std::size_t>(column)] = sums;
    }
}

double QuadricRow::middle(int column) const {
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const int reach = static_cast<int>(weights_.size()) - 1;
    if (row_ < reach || row_ + reach >= height_.rows || column < reach || column + reach >= height_.columns) {
        return nothing;
    }
    double total = 0;
    Terms heights{};
    for (int d = -reach; d <= reach; ++d) {
        const Column& here = columns_[static_cast<std::size_t>(column + d)];
        const double weight = weights_[static_cast<std::size_t>(std::abs(d))], x = distance(d);
        total += weight * here.weight[0];
        heights[0] += weight * here.height[0];
        heights[1] += weight * x * here.height[0];
        heights[2] += weight * here.height[1];
        heights[3] += weight * x * x * here.height[0];
        heights[4] += weight * x * here.height[1];
        heights[5] += weight * here.height[2];
    }
    if (!(total >= whole_ / 2)) {
        return nothing;
    }
    const auto height_by = [&](const Terms& factors) {
        double sum = 0;
        for (std::size_t k = 0; k < terms; ++k) {
            sum += factors[k] * heights[k];
        }
        return sum;
    };
    constexpr double rounding = 1e-9;
    if (total >= (1 - rounding) * whole_) {
        return height_by(of_whole_);
    }
    std::array<std::array<double, powers>, powers> moments{};
    for (int d = -reach; d <= reach; ++d) {
        const Column& here = columns_[static_cast<std::size_t>(column + d)];
        double power = weights_[static_cast<std::size_t>(std::abs(d))];
        for (std::size_t p = 0; p < powers; ++p) {
            for (std::size_t q = 0; p + q < powers; ++q) {
                moments[p][q] += power * here.weight[q];
            }
            power *= distance(d);
        }
    }
    return height_by(factors_of(moments));
}

} // namespace vkfv::topography
