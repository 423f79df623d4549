#include "surface/spatial_parameters.hpp"

#include "core/mathematics/units.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace vkfv::surface {
namespace {

using namespace test;

HeightMap egg_box(double period_x, double period_y, bool gaps) {
    auto map = sampled(300, 240, 0.002, [=](double x, double y) {
        return 0.4 + std::cos(2 * pi * x / period_x) + std::cos(2 * pi * y / period_y);
    });
    if (gaps)
        forget_a_third(map);
    return map;
}

TEST(SpatialParameters, OfAnEggBoxFallAsItsAutocorrelation) {
    // (cos k tx + cos k ty) / 2 falls to 0.2 first along the diagonals, at cos = 0.2 for both, and last along the
    // axes, at cos = -0.6. Overlaps without whole periods leave at most 1 / (k overlap) = 1.5 %, of a slope of 0.98 k
    // and 0.4 k; a third of the points forgotten at random adds less than that.
    const double period = 0.03, k = 2 * pi / period;
    for (const bool gaps : {false, true}) {
        const SpatialParameters p = spatial_parameters(egg_box(period, period, gaps));
        const double shortest = std::acos(0.2) / k * std::sqrt(2.0), longest = std::acos(-0.6) / k;
        EXPECT_NEAR(p.sal, shortest, 0.015 * shortest);
        EXPECT_NEAR(p.str, shortest / longest, 0.03);
    }
}

TEST(SpatialParameters, CountLengthsNotPoints) {
    // A map of the same heights twice as far apart along y has lags along y twice as long.
    auto map = egg_box(0.03, 0.03, false);
    map.pitch_y *= 2;
    const double k = 2 * pi / 0.03;
    const SpatialParameters p = spatial_parameters(map);
    // The shortest and the longest lag on the contour cos k tx + cos k ty / 2 = 0.4, which is like an ellipse, are
    // found by search.
    double shortest = 1, longest = 0;
    for (int i = 0; i <= 2000; ++i) {
        const double tx = std::acos(-0.6) / k * i / 2000.0;
        const double ty = 2 * std::acos(0.4 - std::cos(k * tx)) / k;
        shortest = std::min(shortest, std::hypot(tx, ty));
        longest = std::max(longest, std::hypot(tx, ty));
    }
    EXPECT_NEAR(p.sal, shortest, 0.015 * shortest);
    EXPECT_NEAR(p.str, shortest / longest, 0.03);
}

TEST(SpatialParameters, OfAWaveHaveNoLongestFallAndTheLayOfTheWave) {
    const double period = 0.025;
    for (const double degrees : {-90.0, -60.0, -17.0, 0.0, 30.0, 72.0}) {
        const double wave = degrees * radians_per_degree;
        auto map = sampled(300, 240, 0.002, [=](double x, double y) {
            return 0.1 + 0.001 * std::cos(2 * pi * (x * std::cos(wave) + y * std::sin(wave)) / period);
        });
        for (const bool gaps : {false, true}) {
            if (gaps)
                forget_a_third(map);
            const SpatialParameters p = spatial_parameters(map);
            EXPECT_NEAR(p.sal, std::acos(0.2) / (2 * pi) * period, 0.01 * period);
            EXPECT_TRUE(std::isnan(p.str));
            // The lay is at right angles. A frequency is known to half a line of 1 / 0.48 mm, 0.026 of its 40 / mm.
            const double off = std::remainder(p.std_angle - (wave + pi / 2), pi);
            EXPECT_LT(std::abs(off), 0.026) << degrees;
            EXPECT_GT(p.std_angle, -pi / 2);
            EXPECT_LE(p.std_angle, pi / 2);
        }
    }
}

TEST(SpatialParameters, OfSmoothedNoiseFallAtTheKernelsLength) {
    // White noise through a Gaussian of standard deviation s has the autocorrelation exp(-t^2 / (4 s^2)), 0.2 at 2 s
    // sqrt(ln 5). With n^2 / (2 pi s_x s_y) = 2100 independent patches the estimate at a lag has a standard deviation
    // of 2.2 %, over a slope of 0.2 sqrt(ln 5) / s: 3.4 % of the length. Four of these are allowed, and four of the
    // ratio's.
    const double s_x = 3, s_y = 9;
    const int n = 600;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    auto map = sampled(n, n, 0.001, [&](double, double) { return normal(random); });
    const auto smoothed = [&](const HeightMap& from, double s, bool along_x) {
        HeightMap to = from;
        const int radius = static_cast<int>(4 * s);
        std::vector<double> weights;
        for (int k = -radius; k <= radius; ++k)
            weights.push_back(std::exp(-k * k / (2 * s * s)));
        for (int row = 0; row < n; ++row)
            for (int column = 0; column < n; ++column) {
                double sum = 0;
                for (int k = -radius; k <= radius; ++k) {
                    const int i = along_x ? (column + k + n) % n : column, j = along_x ? row : (row + k + n) % n;
                    sum += weights[static_cast<std::size_t>(k + radius)] * from.height(i, j);
                }
                to.height(column, row) = sum;
            }
        return to;
    };
    map = smoothed(smoothed(map, s_x, true), s_y, false);
    const SpatialParameters p = spatial_parameters(map);
    EXPECT_NEAR(p.sal, 2 * 0.001 * s_x * std::sqrt(std::log(5.0)), 0.14 * p.sal);
    EXPECT_NEAR(p.str, s_x / s_y, 0.2 * s_x / s_y);
    // The wrong twin is the kernel's own width, sqrt(2) less.
    EXPECT_GT(std::abs(p.sal - 0.001 * s_x * std::sqrt(2 * std::log(5.0))), 0.14 * p.sal);
    // Waves run along x: the lay is along y.
    EXPECT_GT(std::abs(p.std_angle), pi / 4);
}

TEST(SpatialParameters, DoNotDependOnTheUnitOfHeights) {
    // Heights are scaled down to an Sq of 0.01 nm, whose squares in mm are 1e-16 of a pair.
    for (const bool gaps : {false, true}) {
        auto map = egg_box(0.03, 0.045, gaps);
        const SpatialParameters p = spatial_parameters(map);
        for (double& z : map.height.values)
            z *= 1e-8;
        const SpatialParameters small = spatial_parameters(map);
        EXPECT_NEAR(small.sal, p.sal, 1e-9 * p.sal);
        EXPECT_NEAR(small.str, p.str, 1e-9);
        EXPECT_NEAR(small.std_angle, p.std_angle, 1e-9);
    }
}

TEST(SpatialParameters, OfAProfileAreThoseAlongIt) {
    const double period = 0.025;
    const auto wave = [=](double x, double y) { return std::cos(2 * pi * (x + y) / period); };
    for (const auto& map : {sampled(300, 1, 0.002, wave), sampled(1, 300, 0.002, wave)})
        EXPECT_NEAR(spatial_parameters(map).sal, std::acos(0.2) / (2 * pi) * period, 0.01 * period);
}

TEST(SpatialParameters, AreUndefinedForAConstantHeight) {
    auto map = sampled(20, 20, 1, [](double, double) { return 0.1; });
    EXPECT_TRUE(std::isnan(spatial_parameters(map).sal));
    for (double& z : map.height.values)
        z = not_measured;
    EXPECT_TRUE(std::isnan(spatial_parameters(map).std_angle));
}

} // namespace
} // namespace vkfv::surface
