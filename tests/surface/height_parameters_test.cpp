#include "surface/height_parameters.hpp"

#include "core/mathematics/units.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vkfv::surface {
namespace {

using namespace test;

TEST(HeightParameters, OfASinusoidAreItsClosedForms) {
    const double amplitude = 0.003;
    // With four whole periods of 25 points, sums over whole periods are exact for sin, sin^2, sin^3 and sin^4.
    const auto map =
        sampled(100, 7, 0.002, [=](double x, double) { return 0.5 + amplitude * std::sin(2 * pi * (x + 0.3) / 0.05); });
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
    const HeightMap map{.height = Grid<double>(2, 2, not_measured), .x0 = 0, .y0 = 0, .pitch_x = 1, .pitch_y = 1};
    const HeightParameters p = height_parameters(map);
    EXPECT_TRUE(std::isnan(p.sq));
    EXPECT_EQ(p.measured_share, 0);
}

TEST(HeightParameters, OfAConstantHeightAreZeroOrUndefined) {
    for (const double height : {0.1, 0.3, 1 / 3.0, 25000.7}) {
        const HeightParameters p = height_parameters(sampled(61, 47, 0.002, [=](double, double) { return height; }));
        EXPECT_EQ(p.mean, height);
        EXPECT_EQ(p.sq, 0);
        EXPECT_EQ(p.sz, 0);
        EXPECT_TRUE(std::isnan(p.ssk));
        EXPECT_TRUE(std::isnan(p.sku));
    }
}

TEST(HeightParameters, OfASampledSinusoidAreTheSumsOverItsPoints) {
    // |sin(2 pi k / n)| sums to 2 cot(pi / n) over the n points of a period: Sa at 16 points is 1.3 % less than the
    // 2 A / pi of the continuous line, and half a point further, where the sum is 2 / sin(pi / n), 0.6 % more.
    const double amplitude = 0.003, pitch = 0.002, n = 16;
    for (const double shift : {0.0, 0.5}) {
        const auto map = sampled(64, 3, pitch, [=](double x, double) {
            return amplitude * std::sin(2 * pi * ((x + 0.3) / pitch + shift) / n);
        });
        const double sa = amplitude * 2 / n / (shift == 0 ? std::tan(pi / n) : std::sin(pi / n));
        EXPECT_NEAR(height_parameters(map).sa, sa, 1e-12 * amplitude);
        EXPECT_GT(std::abs(height_parameters(map).sa / (amplitude * 2 / pi) - 1), 0.005);
    }
}

TEST(HeightParameters, OfASampledTriangleAreTheSumsOverItsPoints) {
    // The values are 0, 1/2, 1, 1/2, 0, -1/2, -1, -1/2 times the amplitude: mean square 3/8 (1/3 on the continuous
    // line), mean fourth power 9/32.
    const double amplitude = 0.004;
    const auto map = sampled(80, 2, 1, [=](double x, double) {
        const double phase = std::fmod(x + 0.3, 8.0);
        return amplitude * (std::abs(std::fmod(phase + 6, 8.0) - 4) / 2 - 1);
    });
    const HeightParameters p = height_parameters(map);
    EXPECT_NEAR(p.sa, amplitude / 2, 1e-15);
    EXPECT_NEAR(p.sq, amplitude * std::sqrt(0.375), 1e-15);
    EXPECT_NEAR(p.ssk, 0, 1e-10);
    EXPECT_NEAR(p.sku, 2, 1e-10);
    EXPECT_NEAR(p.sz, 2 * amplitude, 1e-15);
}

TEST(HeightParameters, OfAStep) {
    // With a share q at the height h and the rest at zero, Sq^2 = q (1 - q) h^2, Sa = 2 q (1 - q) h, Ssk = (1 - 2 q) /
    // sqrt(q (1 - q)).
    const double h = 0.01, q = 0.2;
    const auto map = sampled(50, 4, 1, [=](double x, double) { return x + 0.3 < 9.5 ? h : 0.0; });
    const HeightParameters p = height_parameters(map);
    EXPECT_NEAR(p.sa, 2 * q * (1 - q) * h, 1e-15);
    EXPECT_NEAR(p.sq, std::sqrt(q * (1 - q)) * h, 1e-15);
    EXPECT_NEAR(p.ssk, (1 - 2 * q) / std::sqrt(q * (1 - q)), 1e-12);
    EXPECT_NEAR(p.sp, (1 - q) * h, 1e-15);
    EXPECT_NEAR(p.sv, q * h, 1e-15);
}

TEST(HeightParameters, OfASphereCap) {
    // Over its base, a disc of radius a, the cap has the mean height of its volume, and Sq by the mean of R^2 - r^2.
    const double r = 1, a = 0.4, pitch = 1e-3;
    const auto map = sampled(803, 803, pitch, [=](double x, double y) {
        const double square = std::pow(x + 0.3 - 0.401, 2) + std::pow(y - 0.2 - 0.401, 2);
        return square < a * a ? std::sqrt(r * r - square) : not_measured;
    });
    const double base = std::sqrt(r * r - a * a), h = r - base;
    const double mean = h * h * (3 * r - h) / 3 / (a * a); // over the base
    const double mean_square = r * r - a * a / 2 - 2 * base * (mean + base) + base * base;
    const HeightParameters p = height_parameters(map);
    // Points in a disc of 400 pitches miss its area by less than its rim of 2 pi 400 points, half of them by chance
    // and of random sign: 50 / 5e5 = 1e-4 of all, each wrong by at most the height h.
    EXPECT_NEAR(p.mean, base + mean, 1e-4 * h);
    EXPECT_NEAR(p.sq, std::sqrt(mean_square - mean * mean), 2e-4 * h);
    EXPECT_NEAR(p.sp, h - mean, 2e-4 * h);
    EXPECT_NEAR(p.measured_share, pi * a * a / std::pow(803 * pitch, 2), 1e-4);
}

// The largest number of standard errors by which Sa, Sq, Ssk and Sku of n heights lie off those of a normal
// distribution.
double worst_z(const HeightMap& map, double sigma) {
    const double n = static_cast<double>(map.height.values.size());
    const HeightParameters p = height_parameters(map);
    return std::max({std::abs(p.sa - sigma * std::sqrt(2 / pi)) / (sigma * std::sqrt((1 - 2 / pi) / n)),
                     std::abs(p.sq - sigma) / (sigma / std::sqrt(2 * n)), std::abs(p.ssk) / std::sqrt(6 / n),
                     std::abs(p.sku - 3) / std::sqrt(24 / n)});
}

TEST(HeightParameters, OfNormalNoiseWithinTheirStandardErrors) {
    const double sigma = 0.002;
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal(0, sigma);
    std::uniform_real_distribution<double> uniform(-sigma * std::sqrt(3.0), sigma * std::sqrt(3.0));
    // Four normal values exceed 4.5 with a probability of 4 x 6.8e-6 or less.
    EXPECT_LT(worst_z(sampled(300, 300, 1, [&](double, double) { return normal(random); }), sigma), 4.5);
    // The wrong twins are a uniform distribution of the same Sq, and a standard deviation 3 % greater.
    EXPECT_GT(worst_z(sampled(300, 300, 1, [&](double, double) { return uniform(random); }), sigma), 4.5);
    EXPECT_GT(worst_z(sampled(300, 300, 1, [&](double, double) { return normal(random); }), 1.03 * sigma), 4.5);
}

} // namespace
} // namespace vkfv::surface
