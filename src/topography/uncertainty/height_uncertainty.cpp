#include "topography/uncertainty/height_uncertainty.hpp"

#include "core/threads/parallel_rows.hpp"
#include "topography/local_plane.hpp"
#include "topography/uncertainty/local_quadric.hpp"

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

// Squared distances of the heights from the surface around them; NaN where there is none.
Grid<double> squared_distances(const Grid<double>& height, const FocusWindow& reference) {
    const Grid<double> found = near_zero(height);
    Grid<double> squares(height.columns, height.rows, nothing);
    parallel_rows(height.columns, height.rows, [&](int from, int end) {
        QuadricRow around(found, reference.weights());
        for (int row = from; row < end; ++row) {
            around.move_to(row);
            for (int column = 0; column < height.columns; ++column) {
                if (const double z = found(column, row); std::isfinite(z)) {
                    const double distance = z - around.middle(column);
                    squares(column, row) = distance * distance;
                }
            }
        }
    });
    return squares;
}

// Weights along an axis; the middle one is the point's.
using Weights = std::vector<double>;

Weights weights_of(const FocusWindow& window) {
    Weights weights;
    for (int d = -window.radius(); d <= window.radius(); ++d) {
        weights.push_back(window.weights()[static_cast<std::size_t>(std::abs(d))]);
    }
    return weights;
}

Weights over_their_sum(Weights weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) {
        weight /= total;
    }
    return weights;
}

Weights convolved(const Weights& a, const Weights& b) {
    Weights result(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            result[i + j] += a[i] * b[j];
        }
    }
    return result;
}

// A separable part of the weights: factor x(column) y(row).
struct Product {
    double factor;
    Weights x;
    Weights y;
};

// The overlap of two lists of weights: sum over x of a(x) b(x + d), with the middles at 0.
double overlap(const Weights& a, const Weights& b, int d) {
    const int radius = static_cast<int>(a.size() / 2), other = static_cast<int>(b.size() / 2);
    double sum = 0;
    for (int x = std::max(-radius, -other - d); x <= std::min(radius, other - d); ++x) {
        sum += a[static_cast<std::size_t>(x + radius)] * b[static_cast<std::size_t>(x + d + other)];
    }
    return sum;
}

// The variance of the sum of errors, times these weights, that have this correlation and variance 1:
// height_uncertainty.hpp writes it <f>.
double variance_of(const std::vector<Product>& weights, const Grid<double>& correlation) {
    const int reach = correlation.columns / 2;
    double variance = 0;
    for (const Product& one : weights) {
        for (const Product& other : weights) {
            Weights along_x;
            for (int d = -reach; d <= reach; ++d) {
                along_x.push_back(overlap(one.x, other.x, d));
            }
            for (int dy = -reach; dy <= reach; ++dy) {
                const double along_y = one.factor * other.factor * overlap(one.y, other.y, dy);
                for (int dx = -reach; dx <= reach; ++dx) {
                    variance +=
                        correlation(dx + reach, dy + reach) * along_y * along_x[static_cast<std::size_t>(dx + reach)];
                }
            }
        }
    }
    return variance;
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

const Grid<double>& independent_errors() {
    static const Grid<double> alone(1, 1, 1.0);
    return alone;
}

double scatter_share(const FocusWindow& window, const FocusWindow& reference, const Grid<double>& correlation) {
    const Weights alone = over_their_sum(weights_of(window)), around = weights_of(reference);
    Weights squares = around;
    for (int d = -reference.radius(); d <= reference.radius(); ++d) {
        squares[static_cast<std::size_t>(d + reference.radius())] *= d * d;
    }
    const Grid<double> none(1, 1);
    const QuadricRow::Whole surface = QuadricRow(none, reference.weights()).whole();
    const Weights level = convolved(alone, around), bent = convolved(alone, squares);
    const std::vector<Product> distance = {{1, alone, alone},
                                           {-surface.constant, level, level},
                                           {-surface.square, bent, level},
                                           {-surface.square, level, bent}};
    return variance_of(distance, correlation) / variance_of({distance.front()}, correlation);
}

Grid<double> height_uncertainty(const Grid<double>& height, const Grid<double>& noise, int window_px, WindowShape shape,
                                const Grid<double>& grains) {
    if (noise.columns != height.columns || noise.rows != height.rows) {
        throw std::invalid_argument("height_uncertainty: as many noises as heights are needed");
    }
    const FocusWindow window(window_px, shape), reference = reference_window(window_px, shape);
    const Grid<double> squares = squared_distances(height, reference);
    Mean whole;
    for (const double square : squares.values) {
        whole.add(square);
    }
    const double of_noise = scatter_share(window, reference, independent_errors());
    const double of_texture = scatter_share(window, reference, grains);
    const int reach = 2 * window.radius();
    Grid<double> uncertainty(height.columns, height.rows, nothing);
    parallel_rows(height.columns, height.rows, [&](int from, int end) {
        std::vector<Mean> columns(static_cast<std::size_t>(height.columns)), noises = columns;
        for (int row = from; row < end; ++row) {
            for (int column = 0; column < height.columns; ++column) {
                Mean& sums = columns[static_cast<std::size_t>(column)] = {};
                Mean& by_noise = noises[static_cast<std::size_t>(column)] = {};
                for (int y = std::max(0, row - reach); y <= std::min(height.rows - 1, row + reach); ++y) {
                    sums.add(squares(column, y));
                    if (std::isfinite(squares(column, y))) {
                        by_noise.add(noise(column, y) * noise(column, y));
                    }
                }
            }
            for (int column = 0; column < height.columns; ++column) {
                if (!std::isfinite(height(column, row))) {
                    continue;
                }
                Mean around, by_noise;
                for (int x = std::max(0, column - reach); x <= std::min(height.columns - 1, column + reach); ++x) {
                    around.add(columns[static_cast<std::size_t>(x)]);
                    by_noise.add(noises[static_cast<std::size_t>(x)]);
                }
                const double known = by_noise.count > 0 ? by_noise.value() : 0;
                const double rest = (around.count > 0 ? around : whole).value() - of_noise * known;
                const double here = noise(column, row);
                // NaN if neither part is known.
                uncertainty(column, row) =
                    std::isnan(rest)
                        ? here
                        : std::sqrt((std::isnan(here) ? 0 : here * here) + std::max(0.0, rest) / of_texture);
            }
        }
    });
    return uncertainty;
}

} // namespace vkfv::topography
