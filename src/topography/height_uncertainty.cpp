#include "topography/height_uncertainty.hpp"

#include "core/threads/parallel_rows.hpp"
#include "topography/local_plane.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// From the plane of the reference around it; NaN where too few heights are.
Grid<double> squared_distances(const Grid<double>& height, const FocusWindow& reference) {
    const Grid<double> found = near_zero(height);
    const auto& weights = reference.weights();
    const double side = 2 * std::accumulate(weights.begin(), weights.end(), 0.0) - weights.front();
    const double least = side * side / 2;
    Grid<double> squares(height.columns, height.rows, nothing);
    parallel_rows(height.columns, height.rows, [&](int from, int end) {
        PlaneRow around(found, weights);
        for (int row = from; row < end; ++row) {
            around.move_to(row);
            for (int column = 0; column < height.columns; ++column) {
                const double z = found(column, row);
                if (!std::isfinite(z)) {
                    continue;
                }
                if (const PlaneMoments moments = around.at(column); moments.weight >= least) {
                    const double distance = z - plane_of(moments).middle;
                    squares(column, row) = distance * distance;
                }
            }
        }
    });
    return squares;
}

struct Mean {
    double sum = 0;
    double count = 0;

    void add(double value) {
        if (std::isfinite(value)) {
            sum += value;
            count += 1;
        }
    }
    void add(const Mean& other) {
        sum += other.sum;
        count += other.count;
    }
    double value() const { return sum / count; }
};

} // namespace

FocusWindow reference_window(int width_px, WindowShape shape) {
    const int radius = width_px / 2;
    return {2 * (radius + (radius + 1) / 2) + 1, shape};
}

double scatter_share(const FocusWindow& window, const FocusWindow& reference) {
    const auto weight = [](const FocusWindow& of, int d) {
        return std::abs(d) <= of.radius() ? of.weights()[static_cast<std::size_t>(std::abs(d))] : 0;
    };
    const auto total = [&](const FocusWindow& of) {
        double sum = 0;
        for (int d = -of.radius(); d <= of.radius(); ++d) {
            sum += weight(of, d);
        }
        return sum;
    };
    // Of one axis; a pixel's weight is the product of both.
    const double scale = 1 / total(window), reference_scale = 1 / total(reference);
    const int reach = window.radius() + reference.radius();
    double alone = 0, both = 0, twice = 0;
    for (int d = -reach; d <= reach; ++d) {
        double convolved = 0;
        for (int e = -reference.radius(); e <= reference.radius(); ++e) {
            convolved += reference_scale * weight(reference, e) * scale * weight(window, d - e);
        }
        alone += std::pow(scale * weight(window, d), 2);
        both += scale * weight(window, d) * convolved;
        twice += convolved * convolved;
    }
    return (alone * alone - 2 * both * both + twice * twice) / (alone * alone);
}

Grid<double> height_uncertainty(const Grid<double>& height, const Grid<double>& noise, int window_px,
                                WindowShape shape) {
    if (noise.columns != height.columns || noise.rows != height.rows) {
        throw std::invalid_argument("height_uncertainty: as many noises as heights are needed");
    }
    const FocusWindow window(window_px, shape), reference = reference_window(window_px, shape);
    const Grid<double> squares = squared_distances(height, reference);
    Mean whole;
    for (const double square : squares.values) {
        whole.add(square);
    }
    const double share = scatter_share(window, reference);
    const int reach = 2 * window.radius();
    Grid<double> uncertainty(height.columns, height.rows, nothing);
    parallel_rows(height.columns, height.rows, [&](int from, int end) {
        std::vector<Mean> columns(static_cast<std::size_t>(height.columns));
        for (int row = from; row < end; ++row) {
            for (int column = 0; column < height.columns; ++column) {
                Mean& sums = columns[static_cast<std::size_t>(column)] = {};
                for (int y = std::max(0, row - reach); y <= std::min(height.rows - 1, row + reach); ++y) {
                    sums.add(squares(column, y));
                }
            }
            for (int column = 0; column < height.columns; ++column) {
                if (!std::isfinite(height(column, row))) {
                    continue;
                }
                Mean around;
                for (int x = std::max(0, column - reach); x <= std::min(height.columns - 1, column + reach); ++x) {
                    around.add(columns[static_cast<std::size_t>(x)]);
                }
                const double variance = (around.count > 0 ? around : whole).value() / share;
                // fmax: what is not known is no bound; NaN if neither is.
                uncertainty(column, row) = std::fmax(std::sqrt(variance), noise(column, row));
            }
        }
    });
    return uncertainty;
}

} // namespace vkfv::topography
