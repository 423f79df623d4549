#include "surface/filter.hpp"

#include "core/mathematics/units.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace vkfv::surface {
namespace {

using namespace test;

TEST(Plane, IsFoundToRoundingOverTheMeasuredPoints) {
    auto map = sampled(40, 30, 0.002, [](double x, double y) { return 0.01 + 0.2 * x - 0.05 * y; });
    forget_a_third(map);
    const Plane plane = least_squares_plane(map);
    // Heights up to 0.1 mm carry rounding of 1e-17 mm over an extent of 0.06 mm.
    EXPECT_NEAR(plane.slope_x, 0.2, 1e-13);
    EXPECT_NEAR(plane.slope_y, -0.05, 1e-13);
    const HeightMap level = remove_plane(map, plane);
    int measured = 0;
    for (std::size_t k = 0; k < map.height.values.size(); ++k) {
        EXPECT_EQ(std::isnan(level.height.values[k]), std::isnan(map.height.values[k]));
        if (!std::isnan(level.height.values[k])) {
            EXPECT_NEAR(level.height.values[k], 0, 1e-15);
            ++measured;
        }
    }
    EXPECT_GT(measured, 700);
}

TEST(Plane, ResidualIsOrthogonalToOffsetAndTilt) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    auto map = sampled(25, 31, 0.002, [&](double x, double) { return x * x + 1e-3 * normal(random); });
    forget_a_third(map);
    const HeightMap level = remove_plane(map, least_squares_plane(map));
    double sum = 0, along_x = 0, along_y = 0;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (const double z = level.height(column, row); !std::isnan(z)) {
                sum += z;
                along_x += z * column;
                along_y += z * row;
            }
    // The mean of some n = 520 heights of 0.1 mm, summed one by one, is wrong by at most n roundings of 1.1e-17 mm, at
    // each of n points alike, and is weighted by up to 31.
    const double rounding = 520 * 520 * 1.1e-17;
    EXPECT_NEAR(sum, 0, rounding);
    EXPECT_NEAR(along_x, 0, 31 * rounding);
    EXPECT_NEAR(along_y, 0, 31 * rounding);
}

TEST(Plane, LeavesATiltOpenThatThePointsLeaveOpen) {
    auto map = sampled(5, 5, 0.002, [](double x, double) { return x; });
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 5; ++column)
            if (row != column)
                map.height(column, row) = not_measured;
    const Plane line = least_squares_plane(map);
    // Along the diagonal the heights rise by 1 / sqrt(2).
    EXPECT_NEAR(line.slope_x, 0.5, 1e-12);
    EXPECT_NEAR(line.slope_y, 0.5, 1e-12);
    for (double& height : map.height.values)
        height = not_measured;
    EXPECT_TRUE(std::isnan(least_squares_plane(map).offset));
}

TEST(Plane, LevelsProfilesAlongThem) {
    const auto tilted = [](int columns, int rows) {
        return sampled(columns, rows, 0.002, [](double x, double y) { return 0.1 + 0.2 * x - 0.05 * y; });
    };
    const Plane along_x = least_squares_plane(tilted(300, 1)), along_y = least_squares_plane(tilted(1, 300));
    EXPECT_NEAR(along_x.slope_x, 0.2, 1e-13);
    EXPECT_NEAR(along_x.slope_y, 0, 1e-13);
    EXPECT_NEAR(along_y.slope_x, 0, 1e-13);
    EXPECT_NEAR(along_y.slope_y, -0.05, 1e-13);
    const Plane point = least_squares_plane(tilted(1, 1));
    EXPECT_EQ(point.slope_x, 0);
    EXPECT_EQ(point.slope_y, 0);
    // Two profiles side by side, however long, do settle the tilt across.
    const Plane strip = least_squares_plane(tilted(1000000, 2));
    EXPECT_NEAR(strip.slope_x, 0.2, 1e-13);
    EXPECT_NEAR(strip.slope_y, -0.05, 1e-7); // heights of 400 mm, rounded to 6e-14 mm, 0.002 mm apart
}

// The amplitude of a cosine of wavelength `wavelength` at the middle of the map, after the low-pass of this nesting
// index.
double transmission(double wavelength, double nesting_index, bool along_x) {
    const double pitch = 0.002;
    const auto map = sampled(161, 161, pitch, [=](double x, double y) {
        const double middle = along_x ? x + 0.3 - 80 * pitch : y - 0.2 - 80 * pitch;
        return std::cos(2 * pi * middle / wavelength);
    });
    return gaussian_low_pass(map, nesting_index).height(80, 80);
}

TEST(GaussianFilter, HalfOfTheAmplitudePassesAtTheNestingIndex) {
    // ISO 16610-61 gives exp(-pi (alpha L / wavelength)^2). Cut off at L = 0.08 mm the weights miss less than 1e-5; the
    // sum over points 2 um apart equals the integral to far below that (Poisson).
    const double alpha = std::sqrt(std::log(2.0) / pi);
    for (const bool along_x : {true, false}) {
        EXPECT_NEAR(transmission(0.08, 0.08, along_x), 0.5, 1e-5);
        for (const double wavelength : {0.04, 0.16, 0.32})
            EXPECT_NEAR(transmission(wavelength, 0.08, along_x), std::exp(-pi * std::pow(alpha * 0.08 / wavelength, 2)),
                        1e-5);
    }
    // The wrong twin, a Gaussian of standard deviation L / (2 pi), passes exp(-1/2) = 0.607.
    EXPECT_GT(std::abs(transmission(0.08, 0.08, true) - 0.607), 0.1);
}

TEST(GaussianFilter, KeepsConstantsAtBordersAndAroundNotMeasuredPoints) {
    auto map = sampled(30, 20, 0.002, [](double, double) { return 0.7; });
    forget_a_third(map);
    const HeightMap low = gaussian_low_pass(map, 0.02);
    const HeightMap high = remove_long_waves(map, 0.02);
    for (std::size_t k = 0; k < low.height.values.size(); ++k) {
        EXPECT_EQ(std::isnan(low.height.values[k]), std::isnan(map.height.values[k]));
        if (!std::isnan(low.height.values[k])) {
            EXPECT_NEAR(low.height.values[k], 0.7, 1e-14);
            EXPECT_NEAR(high.height.values[k], 0, 1e-14);
        }
    }
}

TEST(GaussianFilter, NeedsAPositiveNestingIndex) {
    const auto map = sampled(3, 3, 0.002, [](double, double) { return 0.0; });
    EXPECT_THROW(gaussian_low_pass(map, 0), std::invalid_argument);
    EXPECT_THROW(gaussian_low_pass(map, not_measured), std::invalid_argument);
}

TEST(GaussianFilter, ByTransformsIsThatOfWeightedSums) {
    // Heights of three magnitudes, isolated points, odd sizes, and windows shorter and longer than the map give the
    // same by both.
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (const auto& [columns, rows] : {std::pair(157, 83), std::pair(1, 90), std::pair(64, 1)}) {
        for (const double offset : {0.0, 1e3}) {
            auto map = sampled(columns, rows, 0.002, [&](double x, double y) {
                return offset + std::sin(60 * x) + x * y + 0.1 * normal(random);
            });
            map.pitch_y = 0.003;
            forget_a_third(map);
            for (int row = 0; row < rows / 2; ++row)
                for (int column = 0; column < columns / 2; ++column)
                    if ((column * row) % 17 != 3)
                        map.height(column, row) = not_measured;
            for (const double nesting_index : {0.003, 0.02, 0.1, 5.0}) {
                const HeightMap direct = gaussian_low_pass(map, nesting_index, Convolution::direct);
                const HeightMap by_transforms = gaussian_low_pass(map, nesting_index, Convolution::by_transforms);
                for (std::size_t k = 0; k < direct.height.values.size(); ++k) {
                    ASSERT_EQ(std::isnan(direct.height.values[k]), std::isnan(by_transforms.height.values[k]));
                    if (!std::isnan(direct.height.values[k])) {
                        // Weighted sums of heights about 1000 round by some 1e-13 of them.
                        ASSERT_NEAR(by_transforms.height.values[k], direct.height.values[k], 1e-9);
                    }
                }
            }
        }
    }
}

TEST(GaussianFilter, OfAnIndexFarBeyondTheMapIsItsMean) {
    const auto map = sampled(7, 5, 0.002, [](double x, double y) { return x * x - y; });
    double sum = 0;
    for (const double height : map.height.values)
        sum += height;
    // A weighting window of as many points would not fit into memory.
    for (const double height : gaussian_low_pass(map, 1e9).height.values)
        EXPECT_NEAR(height, sum / 35, 1e-15);
}

} // namespace
} // namespace vkfv::surface
