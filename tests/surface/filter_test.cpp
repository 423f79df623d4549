#include "surface/filter.hpp"

#include "core/units.hpp"
#include "surface/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace vkfv::surface {
namespace {

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

template <class Function>
HeightMap sampled(int columns, int rows, double pitch, const Function& function) {
    HeightMap map{
        .height = Grid<double>(columns, rows), .x0 = -0.3, .y0 = 0.2, .pitch_x = pitch, .pitch_y = pitch};
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            map.height(column, row) = function(map.x(column), map.y(row));
    return map;
}

void forget_a_third(HeightMap& map) {
    std::mt19937 random(3);
    for (double& height : map.height.values)
        if (random() % 3 == 0)
            height = not_measured;
}

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
    // The mean of some n = 520 heights of 0.1 mm, summed one by one, is wrong by at most n roundings
    // of 1.1e-17 mm, at each of n points alike; weighted by up to 31.
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
    EXPECT_EQ(line.slope_x, 0);
    EXPECT_EQ(line.slope_y, 0);
    for (double& height : map.height.values)
        height = not_measured;
    EXPECT_TRUE(std::isnan(least_squares_plane(map).offset));
}

// Amplitude of a cosine of wavelength `wavelength` at the middle of the map, after the low-pass of index L.
double transmission(double wavelength, double nesting_index, bool along_x) {
    const double pitch = 0.002;
    const auto map = sampled(161, 161, pitch, [=](double x, double y) {
        const double middle = along_x ? x + 0.3 - 80 * pitch : y - 0.2 - 80 * pitch;
        return std::cos(2 * pi * middle / wavelength);
    });
    return gaussian_low_pass(map, nesting_index).height(80, 80);
}

TEST(GaussianFilter, HalfOfTheAmplitudePassesAtTheNestingIndex) {
    // ISO 16610-61: exp(-pi (alpha L / wavelength)^2). Cut off at L = 0.08 mm the weights miss less than
    // 1e-5; the sum over points 2 um apart equals the integral to far below that (Poisson).
    const double alpha = std::sqrt(std::log(2.0) / pi);
    for (const bool along_x : {true, false}) {
        EXPECT_NEAR(transmission(0.08, 0.08, along_x), 0.5, 1e-5);
        for (const double wavelength : {0.04, 0.16, 0.32})
            EXPECT_NEAR(transmission(wavelength, 0.08, along_x),
                        std::exp(-pi * std::pow(alpha * 0.08 / wavelength, 2)), 1e-5);
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

TEST(HeightParameters, OfASinusoidAreItsClosedForms) {
    const double amplitude = 0.003;
    // Four whole periods of 25 points: sums over whole periods are exact for sin, sin^2, sin^3 and sin^4.
    const auto map = sampled(100, 7, 0.002, [=](double x, double) {
        return 0.5 + amplitude * std::sin(2 * pi * (x + 0.3) / 0.05);
    });
    const HeightParameters p = height_parameters(map);
    EXPECT_NEAR(p.mean, 0.5, 1e-14);
    EXPECT_NEAR(p.sq, amplitude / std::sqrt(2.0), 1e-14);
    EXPECT_NEAR(p.ssk, 0, 1e-10);
    EXPECT_NEAR(p.sku, 1.5, 1e-10);
    // |sin| has kinks: the mean over 25 points a period misses 2/pi by (pi/25)^2 / 12 relative or less.
    EXPECT_NEAR(p.sa, amplitude * 2 / pi, amplitude * 2 / pi * 1.4e-3);
    // The highest point lies within half a step, 2 pi / 50, of the crest.
    EXPECT_NEAR(p.sz, 2 * amplitude, 2 * amplitude * 0.5 * std::pow(2 * pi / 50, 2));
    EXPECT_DOUBLE_EQ(p.sz, p.sp + p.sv);
    EXPECT_EQ(p.measured_share, 1);
}

TEST(HeightParameters, OfFourPointsAreThoseOfTheHand) {
    HeightMap map{.height = Grid<double>(5, 1), .x0 = 0, .y0 = 0, .pitch_x = 1, .pitch_y = 1};
    map.height.values = {1, 1, not_measured, 1, 5};
    const HeightParameters p = height_parameters(map); // deviations -1 -1 -1 3
    EXPECT_DOUBLE_EQ(p.mean, 2);
    EXPECT_DOUBLE_EQ(p.sa, 1.5);
    EXPECT_DOUBLE_EQ(p.sq, std::sqrt(3.0));
    EXPECT_DOUBLE_EQ(p.ssk, 6 / std::pow(3.0, 1.5));
    EXPECT_DOUBLE_EQ(p.sku, 21 / 9.0);
    EXPECT_DOUBLE_EQ(p.sp, 3);
    EXPECT_DOUBLE_EQ(p.sv, 1);
    EXPECT_DOUBLE_EQ(p.measured_share, 0.8);
}

TEST(HeightParameters, AreUndefinedWithoutMeasuredPoints) {
    const HeightMap map{
        .height = Grid<double>(2, 2, not_measured), .x0 = 0, .y0 = 0, .pitch_x = 1, .pitch_y = 1};
    const HeightParameters p = height_parameters(map);
    EXPECT_TRUE(std::isnan(p.sq));
    EXPECT_EQ(p.measured_share, 0);
}

} // namespace
} // namespace vkfv::surface
