#include "topography/flatness.hpp"

#include "core/mathematics/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace vkfv::topography {
namespace {

constexpr int points = 161;
constexpr double spacing = 2e-3, period = 0.128; // mm: 2.5 periods, 0 at the borders
constexpr double amplitude = 1e-3, texture = 0.4e-3, bowl = 2e-3;

template <class Height>
surface::HeightMap flat_of(const Height& height) {
    surface::HeightMap map{
        .height = Grid<double>(points, points), .x0 = 3, .y0 = -5, .pitch_x = spacing, .pitch_y = spacing};
    for (int row = 0; row < points; ++row) {
        for (int column = 0; column < points; ++column) {
            map.height(column, row) = height(column, row);
        }
    }
    return map;
}

double long_wave(int column) {
    return amplitude * std::cos(2 * pi * (column - points / 2) * spacing / period);
}

// A tilted flat with a wave that no polynomial follows and a texture of two points.
surface::HeightMap wavy_flat() {
    return flat_of([](int column, int row) {
        return 0.5 + 1e-4 * column - 2e-4 * row + long_wave(column) + (column % 2 == 0 ? texture : -texture);
    });
}

TEST(Flatness, IsTheMaximumHeightOfTheLevelledFilteredFlat) {
    // The wave is even about the middle, so that removing a plane does not change it; its extremes stand a window
    // inside the borders. 2^-(L / period)^2 of a wave passes; of a texture of two points 2^-25 at least.
    for (const double index : {0.02, 0.04}) {
        const double kept = std::exp2(-std::pow(index / period, 2));
        EXPECT_NEAR(flatness_deviation(wavy_flat(), index), 2 * amplitude * kept, 0.01 * amplitude) << index;
    }
    EXPECT_NEAR(flatness_deviation(wavy_flat(), 0), 2 * (amplitude + texture), 0.01 * amplitude);
    // The wrong twin is the polynomial that the correction takes off: it has the tilt in it.
    const auto corrected = correct_flatness(flat_of([](int, int) { return 0.0; }), wavy_flat());
    EXPECT_GT(corrected.polynomial_peak_to_valley, 10 * flatness_deviation(wavy_flat(), 0.02));
}

TEST(Flatness, LeavesOutWhatIsNotMeasured) {
    auto flat = wavy_flat();
    const double whole = flatness_deviation(flat, 0.02);
    flat.height(40, 7) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NEAR(flatness_deviation(flat, 0.02), whole, 0.01 * whole);
    for (double& height : flat.height.values) {
        height = std::numeric_limits<double>::quiet_NaN();
    }
    EXPECT_TRUE(std::isnan(flatness_deviation(flat, 0.02)));
}

TEST(Flatness, CorrectionTellsWhatItTookOff) {
    const auto curved = [](int column, int row) {
        const double x = column / (points - 1.0) - 0.5, y = row / (points - 1.0) - 0.5;
        return bowl * (x * x + y * y);
    };
    const auto measured = flat_of([&](int column, int row) { return long_wave(column) + curved(column, row); });
    const auto corrected = correct_flatness(measured, flat_of(curved));
    EXPECT_NEAR(corrected.polynomial_peak_to_valley, bowl / 2, 1e-9);
    for (int column = 0; column < points; ++column) {
        EXPECT_NEAR(corrected.heights.height(column, 9), long_wave(column), 1e-9);
    }
    // A bowl is level already: all of it is the deviation, but for what the filter rounds off at the corners.
    EXPECT_NEAR(flatness_deviation(flat_of(curved), 0.004), bowl / 2, 0.02 * bowl);
    EXPECT_THROW(correct_flatness(measured, surface::HeightMap{}), std::invalid_argument);
}

// A tilted field adds its deviation from the mean over the measured points alone to the uncertainty, by squares.
TEST(Flatness, CurvatureThatStaysAddsToTheUncertainty) {
    auto heights = flat_of([](int, int) { return 7.0; });
    for (int row = 0; row < points; ++row) {
        for (int column = points - 20; column < points; ++column) {
            heights.height(column, row) = std::numeric_limits<double>::quiet_NaN(); // not measured
        }
    }
    const auto field = [](double x, double y) { return 5 + 0.01 * (x - 3) + 0 * y; };
    Grid<double> uncertainty(points, points, 3e-4);
    const int last = points - 21;
    EXPECT_NEAR(add_curvature(uncertainty, heights, field), 0.01 * last * spacing, 1e-12);
    for (const int column : {0, 31, last}) {
        EXPECT_NEAR(uncertainty(column, 9), std::hypot(3e-4, 0.01 * spacing * (column - 0.5 * last)), 1e-12);
    }
    EXPECT_NEAR(uncertainty(last / 2, 9), 3e-4, 1e-12); // none at the mean
    EXPECT_TRUE(std::isnan(uncertainty(points - 1, 9)));

    for (double& height : heights.height.values) {
        height = std::numeric_limits<double>::quiet_NaN();
    }
    EXPECT_EQ(add_curvature(uncertainty, heights, field), 0);
    EXPECT_THROW(add_curvature(uncertainty, surface::HeightMap{}, field), std::invalid_argument);
}

} // namespace
} // namespace vkfv::topography
