#include "surface/hybrid_parameters.hpp"

#include "core/mathematics/units.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::surface {
namespace {

using namespace test;

TEST(HybridParameters, OfATiltedPlaneAreItsSlopeAndItsSecant) {
    auto map = sampled(40, 30, 0.002, [](double x, double y) { return 0.3 * x - 0.4 * y; });
    map.pitch_y = 0.004; // half the slope along y
    map.height(7, 9) = not_measured;
    const double slope = std::hypot(0.3, 0.2);
    const HybridParameters p = hybrid_parameters(map);
    EXPECT_NEAR(p.sdq, slope, 1e-12);
    EXPECT_NEAR(p.sdr, std::sqrt(1 + slope * slope) - 1, 1e-12);
}

TEST(HybridParameters, OfASampledSinusoidKeepTheShareOfDifferences) {
    const double amplitude = 1e-4, pitch = 0.002, n = 16;
    for (const bool along_x : {true, false}) {
        // There are whole periods between the first and the last point: differences average over all phases alike.
        const auto map = sampled(65, 65, pitch, [=](double x, double y) {
            return amplitude * std::sin(2 * pi * (along_x ? x : y) / (n * pitch));
        });
        const double sdq = amplitude * 2 * std::sin(pi / n) / pitch / std::sqrt(2.0);
        const HybridParameters p = hybrid_parameters(map);
        EXPECT_NEAR(p.sdq, sdq, 1e-9 * sdq);
        // The next term of the root is less by a quarter of the squared slope, which is at most 2 Sdq^2.
        EXPECT_NEAR(p.sdr, sdq * sdq / 2, 0.5 * std::pow(sdq, 4));
    }
}

TEST(HybridParameters, OfAnEggBoxComeNearItsGradient) {
    // z = A cos(k x) cos(k y): Sdq is A k / sqrt(2). Differences along an axis keep sin(k h / 2) / (k h / 2), the mean
    // over a cell cos(k h / 2) more of half the square.
    const double amplitude = 1e-4, pitch = 0.002, n = 10, k = 2 * pi / (n * pitch);
    auto map =
        sampled(401, 401, pitch, [=](double x, double y) { return amplitude * std::cos(k * x) * std::cos(k * y); });
    const double share = std::sin(pi / n) / (pi / n), exact = amplitude * k / std::sqrt(2.0);
    EXPECT_NEAR(share, 0.984, 5e-4); // 1.6 % lost
    const HybridParameters p = hybrid_parameters(map);
    // The map has a row more than whole periods: a 400th of the mean square along the other axis.
    EXPECT_NEAR(p.sdq, share * exact, 2e-3 * exact);
    EXPECT_NEAR(p.sdr, std::pow(share * exact, 2) / 2, 2.5e-3 * exact * exact);
    // The parameter is nearer than the mean of cells, the wrong twin.
    EXPECT_GT(p.sdq, 1.01 * share * exact * std::sqrt((1 + std::pow(std::cos(pi / n), 2)) / 2));
    // A third of 160 000 points forgotten leaves 70 000 pairs: 1 / sqrt(2 x 70 000) of scatter.
    forget_a_third(map);
    EXPECT_NEAR(hybrid_parameters(map).sdq, share * exact, 0.01 * exact);
}

TEST(HybridParameters, OfASphereCapGiveItsArea) {
    // The cap's area is 2 pi R h over pi a^2. Sdq^2 is the mean of r^2 / (R^2 - r^2) over the disc, -(R/a)^2 ln(1 -
    // (a/R)^2) - 1.
    const double r = 1, a = 0.4;
    const auto map = sampled(803, 803, 1e-3, [=](double x, double y) {
        const double square = std::pow(x + 0.3 - 0.401, 2) + std::pow(y - 0.2 - 0.401, 2);
        return square < a * a ? std::sqrt(r * r - square) : not_measured;
    });
    const double h = r - std::sqrt(r * r - a * a);
    const HybridParameters p = hybrid_parameters(map);
    // Whole cells end about 2/3 of a pitch before the rim, 2 x 1.7e-3 of the area, and with it a rim whose excess is
    // about twice the mean: the mean of the rest is less by that share.
    EXPECT_NEAR(p.sdr, 2 * r * h / (a * a) - 1, 4e-3 * p.sdr);
    EXPECT_NEAR(p.sdq * p.sdq, -std::pow(r / a, 2) * std::log(1 - std::pow(a / r, 2)) - 1, 4e-3 * p.sdq * p.sdq);
    EXPECT_LT(p.sdr, 2 * r * h / (a * a) - 1);
}

TEST(HybridParameters, AreUndefinedWithoutAWholeCell) {
    const auto map =
        sampled(5, 5, 1, [](double x, double) { return std::fmod(x + 0.3, 2.0) < 0.5 ? 0 : not_measured; });
    EXPECT_TRUE(std::isnan(hybrid_parameters(map).sdq));
    EXPECT_TRUE(std::isnan(hybrid_parameters(map).sdr));
}

// Differences of twice the spacing keep sin(2 a) / (2 a) over sin(a) / a = cos(a) of the slope, a = pi over the points
// a period.
TEST(HybridParameters, TellWhatSamplingTakesOfTheSlope) {
    for (const double points : {8.0, 16.0, 40.0}) {
        const auto map = sampled(4000, 4, 1, [&](double x, double) { return std::sin(2 * pi * x / points); });
        const auto p = hybrid_parameters(map);
        // The ends lack a difference of 4000, or two: a sixth of that is missing in the loss.
        EXPECT_NEAR(p.sdq_loss, (1 - std::cos(pi / points)) / 3, 1e-4);
        // The extrapolation comes near the slope itself.
        const double slope = 2 * pi / points / std::sqrt(2.0);
        EXPECT_NEAR(p.sdq * (1 + p.sdq_loss), slope, 0.004 * slope);
    }
    EXPECT_TRUE(std::isnan(hybrid_parameters(sampled(9, 9, 1, [](double, double) { return 1.0; })).sdq_loss));
}

} // namespace
} // namespace vkfv::surface
