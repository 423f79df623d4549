// The uncertainty that heights tell of themselves agrees with windows of known errors, on slopes, beside gaps and at
// steps.
#include "topography/uncertainty/height_uncertainty.hpp"

#include "topography/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <stdexcept>

namespace vkfv::topography {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// Means over the window of independent errors of pixels, of standard deviation 1 each.
Grid<double> windowed_errors(int side, const FocusWindow& window, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const int radius = window.radius();
    Grid<double> white(side + 2 * radius, side + 2 * radius), height(side, side);
    for (double& value : white.values) {
        value = normal(random);
    }
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            double sum = 0, total = 0;
            for (int y = -radius; y <= radius; ++y) {
                for (int x = -radius; x <= radius; ++x) {
                    const double weight = window.weights()[static_cast<std::size_t>(std::abs(x))] *
                                          window.weights()[static_cast<std::size_t>(std::abs(y))];
                    sum += weight * white(column + x + radius, row + y + radius);
                    total += weight;
                }
            }
            height(column, row) = sum / total;
        }
    }
    return height;
}

Grid<double> of(int side, double value) {
    return Grid<double>(side, side, value);
}

double root_mean_square(const Grid<double>& grid, int border = 0) {
    double sum = 0, count = 0;
    for (int row = border; row < grid.rows - border; ++row) {
        for (int column = border; column < grid.columns - border; ++column) {
            sum += grid(column, row) * grid(column, row);
            count += 1;
        }
    }
    return std::sqrt(sum / count);
}

TEST(HeightUncertainty, TheShareIsThatOfTheDefinition) {
    // The truth is the surface of second degree over a square, at its middle, by Legendre's polynomials of u and v from
    // -1 to 1: m = (1 - 5/2 (P2(u) + P2(v))) / 4, of which the sums over 61 points are off by a step's share.
    const auto window = FocusWindow(61, WindowShape::box), reference = reference_window(61, WindowShape::box);
    const int inner = window.radius(), outer = reference.radius(), reach = inner + outer;
    const auto legendre = [&](int d) {
        const double u = d / (outer + 0.5);
        return 1.5 * u * u - 0.5;
    };
    Grid<double> distance(2 * reach + 1, 2 * reach + 1);
    const double k = 1 / std::pow(2 * inner + 1, 2), m = 1 / std::pow(2 * outer + 1, 2);
    for (int y = -inner; y <= inner; ++y) {
        for (int x = -inner; x <= inner; ++x) {
            distance(x + reach, y + reach) += k;
            for (int dy = -outer; dy <= outer; ++dy) {
                for (int dx = -outer; dx <= outer; ++dx) {
                    distance(x + dx + reach, y + dy + reach) -= k * m * (1 - 2.5 * (legendre(dx) + legendre(dy)));
                }
            }
        }
    }
    double squares = 0;
    for (const double value : distance.values) {
        squares += value * value;
    }
    EXPECT_NEAR(scatter_share(window, reference), squares / k, 0.01);
    EXPECT_EQ(reference_window(7, WindowShape::box).radius(), 5);
}

TEST(HeightUncertainty, IsTheErrorOfWindowsWhosePixelsErrAlone) {
    constexpr int side = 160;
    for (const auto shape : {WindowShape::box, WindowShape::gaussian}) {
        for (const int width : {5, 9, 15}) {
            SCOPED_TRACE(width);
            const FocusWindow window(width, shape);
            const Grid<double> height = windowed_errors(side, window, 1);
            const double error = 1 / std::sqrt(window.pixels(side, side, side / 2, side / 2));
            const auto found = height_uncertainty(height, of(side, 0), width, shape);
            // Some 450 independent distances on the map of the widest window tell a standard deviation to 3 %. A
            // wrong share of the variance, of the window as its own reference, would be off by 15 % at least.
            EXPECT_GT(scatter_share(window, reference_window(width, shape)), 1.3 * scatter_share(window, window));
            EXPECT_NEAR(root_mean_square(found, width) / error, 1, 0.04);
            EXPECT_NEAR(root_mean_square(found) / error, 1, 0.05); // with the border
            const double beyond = share_beyond({.height = height}, found, 3);
            EXPECT_LT(beyond, 0.02); // 0.003 for normal errors with a known standard deviation
        }
    }
}

// Pixels' errors are means of 3 x 3 independent ones, of variance 1: neighbours share two thirds, pixels two apart one
// third.
TEST(HeightUncertainty, KnowsOfErrorsThatNeighboursHaveInCommon) {
    constexpr int side = 160, width = 7;
    const FocusWindow window(width, WindowShape::box), grain(3, WindowShape::box);
    const Grid<double> pixels = windowed_errors(side + width - 1, grain, 5);
    Grid<double> height(side, side), grains(5, 5);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            for (int y = 0; y < width; ++y) {
                for (int x = 0; x < width; ++x) {
                    height(column, row) += 3 * pixels(column + x, row + y) / (width * width);
                }
            }
        }
    }
    for (int y = -2; y <= 2; ++y) {
        for (int x = -2; x <= 2; ++x) {
            grains(x + 2, y + 2) = (1 - std::abs(x) / 3.0) * (1 - std::abs(y) / 3.0);
        }
    }
    // The variance along an axis is the sum over d of (7 - |d|) (3 - |d|) / 3 / 49, and both axes have it.
    const double along = (7 + 2 * (6 * 2.0 + 5) / 3) / 49, error = along;
    const auto found = height_uncertainty(height, of(side, 0), width, WindowShape::box, grains);
    EXPECT_NEAR(root_mean_square(found, width) / error, 1, 0.05);
    // The wrong twin has errors that each pixel has alone.
    const auto twin = height_uncertainty(height, of(side, 0), width, WindowShape::box);
    EXPECT_LT(root_mean_square(twin, width) / error, 0.75);

    // Noise of independent pixels, as large, is added: its part is taken off first.
    const Grid<double> noise = windowed_errors(side, window, 6);
    Grid<double> both = height;
    for (std::size_t k = 0; k < both.values.size(); ++k) {
        both.values[k] += noise.values[k] * width * error;
    }
    const auto apart = height_uncertainty(both, of(side, error), width, WindowShape::box, grains);
    EXPECT_NEAR(root_mean_square(apart, width) / error, std::sqrt(2), 0.07);
    const auto mixed = height_uncertainty(both, of(side, 0), width, WindowShape::box, grains);
    EXPECT_GT(root_mean_square(mixed, width) / error, 1.55);
}

TEST(HeightUncertainty, ASurfaceOfSecondDegreeIsNoUncertaintyNorAreGapsOnIt) {
    constexpr int side = 60;
    const FocusWindow window(7, WindowShape::box);
    const Grid<double> errors = windowed_errors(side, window, 2);
    const auto level = height_uncertainty(errors, of(side, 0), 7, WindowShape::box);
    std::mt19937 random(3);
    Grid<double> ramp(side, side);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const bool gap = random() % 4 == 0;
            ramp(column, row) =
                gap ? nothing
                    : 1e4 + errors(column, row) + 5 * column - 3 * row + 0.3 * column * column - 0.2 * column * row;
        }
    }
    const auto found = height_uncertainty(ramp, of(side, 0), 7, WindowShape::box);
    double ratio = 0, count = 0;
    for (std::size_t k = 0; k < found.values.size(); ++k) {
        EXPECT_EQ(std::isfinite(found.values[k]), std::isfinite(ramp.values[k]));
        if (std::isfinite(found.values[k])) {
            ratio += found.values[k] / level.values[k];
            count += 1;
        }
    }
    EXPECT_NEAR(ratio / count, 1, 0.05);
}

TEST(HeightUncertainty, IsNotBelowTheNoise) {
    constexpr int side = 20;
    Grid<double> noise = of(side, 0.5);
    noise(3, 4) = nothing;
    const auto found = height_uncertainty(of(side, 1), noise, 5, WindowShape::box);
    EXPECT_EQ(found(10, 10), 0.5);
    EXPECT_EQ(found(3, 4), 0); // equal heights, and no noise known
    EXPECT_THROW(height_uncertainty(of(side, 1), of(side + 1, 1), 5, WindowShape::box), std::invalid_argument);
}

TEST(HeightUncertainty, LonelyHeightsHaveThatOfTheMap) {
    constexpr int side = 80;
    const FocusWindow window(5, WindowShape::box);
    Grid<double> height = windowed_errors(side, window, 4);
    for (int row = 0; row < side; ++row) {
        for (int column = 40; column < side; ++column) {
            if (row != 40 || column != 60) {
                height(column, row) = nothing;
            }
        }
    }
    const auto found = height_uncertainty(height, of(side, 0), 5, WindowShape::box);
    EXPECT_NEAR(found(60, 40) * 5, 1, 0.1);
    // For a lonely height in an empty map its noise is all that is known.
    const auto alone = height_uncertainty(
        [&] {
            auto map = of(side, nothing);
            map(7, 7) = 1;
            return map;
        }(),
        of(side, 0.2), 5, WindowShape::box);
    EXPECT_EQ(alone(7, 7), 0.2);
}

TEST(HeightUncertainty, CountsWhatLiesBeyond) {
    surface::HeightMap deviation{.height = of(2, 0)};
    deviation.height.values = {0.0, 3.1, -2.9, nothing};
    EXPECT_NEAR(share_beyond(deviation, of(2, 1), 3), 1.0 / 3, 1e-12);
    EXPECT_TRUE(std::isnan(share_beyond({.height = of(2, nothing)}, of(2, 1), 3)));
    EXPECT_THROW(share_beyond(deviation, of(3, 1), 3), std::invalid_argument);
}

} // namespace
} // namespace vkfv::topography
