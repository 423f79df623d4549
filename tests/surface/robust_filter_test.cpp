#include "surface/robust_filter.hpp"

#include "core/mathematics/units.hpp"
#include "surface/band.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

namespace vkfv::surface {
namespace {

using namespace test;

constexpr double noise = 1e-4;

HeightMap noisy(unsigned seed = 1) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, noise);
    return sampled(120, 100, 1e-3,
                   [&](double x, double) { return 2e-4 * std::cos(2 * pi * x / 0.05) + normal(random); });
}

double root_mean_square(const HeightMap& a, const HeightMap& b) {
    double sum = 0, count = 0;
    for (std::size_t k = 0; k < a.height.values.size(); ++k)
        if (const double d = a.height.values[k] - b.height.values[k]; std::isfinite(d)) {
            sum += d * d;
            count += 1;
        }
    return std::sqrt(sum / count);
}

// The map has a spike a thousand times the noise, which a mean spreads over its window.
TEST(RobustFilter, SpikesAndHolesTakeNoPart) {
    const HeightMap clean = noisy();
    HeightMap spiked = clean;
    spiked.height(60, 50) += 0.1;
    spiked.height(20, 70) -= 0.1;
    const double index = 0.01;
    const HeightMap low = robust_gaussian_low_pass(spiked, index);
    // Two points fewer are in the window, which some 2 x 50 of 12 000 places see: less than the noise by far.
    EXPECT_LT(root_mean_square(low, robust_gaussian_low_pass(clean, index)), 0.05 * noise);
    // The wrong twin is the linear filter.
    EXPECT_GT(root_mean_square(gaussian_low_pass(spiked, index), gaussian_low_pass(clean, index)), 0.5 * noise);
}

// The biweight's c is 3 standard deviations. Its efficiency is then 0.7727, (E psi')^2 / E psi^2 of psi = x (1 -
// (x/3)^2)^2 over the normal distribution by quadrature. So both means differ by sqrt(1 / 0.7727 - 1) of the linear
// one's own noise; to a fifth with 44 points in a window.
TEST(RobustFilter, DiffersFromTheLinearOneByItsEfficiencyWhereNothingStandsOut) {
    const HeightMap map = noisy();
    const double index = 0.01, alpha = std::sqrt(std::numbers::ln2 / pi);
    // The noise of the linear mean is one over the root of its effective number of points, 2 (alpha L)^2.
    const double own = noise / std::sqrt(2 * std::pow(alpha * index / map.pitch_x, 2));
    const double expected = std::sqrt(1 / 0.7727 - 1) * own;
    EXPECT_NEAR(root_mean_square(robust_gaussian_low_pass(map, index), gaussian_low_pass(map, index)), expected,
                expected / 5);
}

TEST(RobustFilter, KeepsGapsAndConstants) {
    HeightMap map = sampled(30, 20, 1e-3, [](double, double) { return 0.7; });
    forget_a_third(map);
    const HeightMap low = robust_gaussian_low_pass(map, 0.005);
    for (std::size_t k = 0; k < map.height.values.size(); ++k) {
        EXPECT_EQ(std::isnan(low.height.values[k]), std::isnan(map.height.values[k]));
        if (std::isfinite(map.height.values[k])) {
            EXPECT_NEAR(low.height.values[k], 0.7, 1e-12);
        }
    }
    EXPECT_THROW(robust_gaussian_low_pass(map, 0), std::invalid_argument);
}

TEST(RobustFilter, IsOneOfTheBandsFilters) {
    Band band{.s_filter = 0.01};
    take_filter(band, "robust-gaussian");
    EXPECT_STREQ(filter_name(band), "robust-gaussian");
    HeightMap map = noisy();
    map.height(60, 50) += 0.1;
    EXPECT_LT(height_parameters(filtered(map, band)).sz, 1e-3);
    take_filter(band, "gaussian");
    EXPECT_FALSE(band.robust);
    EXPECT_GT(height_parameters(filtered(map, band)).sz, 1e-3);
}

} // namespace
} // namespace vkfv::surface
