#include "surface/material_ratio.hpp"

#include "core/mathematics/units.hpp"
#include "surface/maps.hpp"
#include "surface/volume_parameters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vkfv::surface {
namespace {

using namespace test;

double density(double t) {
    return std::exp(-t * t / 2) / std::sqrt(2 * pi);
}
double tail(double t) {
    return 0.5 * std::erfc(t / std::sqrt(2.0));
}

// The height t above which the tail holds this share: tail(t) = share.
double quantile(double share) {
    double low = -10, high = 10;
    for (int k = 0; k < 60; ++k)
        (tail((low + high) / 2) > share ? low : high) = (low + high) / 2;
    return (low + high) / 2;
}

// Heights that follow the normal distribution without chance, strewn over the map.
HeightMap normal_heights(double sigma) {
    auto map = sampled(200, 200, 1, [](double, double) { return 0.0; });
    const double n = static_cast<double>(map.height.values.size());
    for (std::size_t k = 0; k < map.height.values.size(); ++k)
        map.height.values[k] = 0.05 + sigma * quantile((static_cast<double>(k) + 0.5) / n);
    std::shuffle(map.height.values.begin(), map.height.values.end(), std::mt19937(1));
    return map;
}

TEST(MaterialRatio, OfANormalDistributionHasItsClosedForms) {
    const double sigma = 0.002;
    const MaterialRatioCurve curve(normal_heights(sigma));
    EXPECT_NEAR(curve.height(0.5), 0.05, 1e-9);
    // The curve is linear between points a ratio of 2.5e-5 apart.
    EXPECT_NEAR(curve.height(0.1), 0.05 + sigma * quantile(0.1), 1e-8);
    EXPECT_NEAR(curve.ratio(0.05 + sigma), tail(1), 1e-7);

    const RatioParameters ratio = ratio_parameters(curve);
    EXPECT_NEAR(ratio.sxp, sigma * quantile(0.025), 1e-7);
    EXPECT_NEAR(ratio.sdc, 2 * sigma * quantile(0.02), 1e-7);

    // The flattest 40 % lie about the median, between -t and t. With P the distribution the line's fall over all
    // ratios is the integral of t (P - 1/2) over that of (P - 1/2)^2, by parts and with density^2 integrated:
    const double t = quantile(0.3);
    const double fall = (0.5 / std::sqrt(pi) * std::erf(t) - 2 * 0.2 * density(t)) / (2 * std::pow(0.2, 3) / 3);
    const CoreParameters p = core_parameters(curve);
    // With n = 40 000 points the window is right to some points, the sums to 1/n^2; the tails' last points, each 1/n of
    // the area, are known to a share of a standard deviation or so.
    EXPECT_NEAR(p.sk, sigma * fall, 1e-5 * sigma);
    const double share = tail(fall / 2);
    EXPECT_NEAR(p.smr1, share, 1e-5);
    EXPECT_NEAR(p.smr2, 1 - share, 1e-5);
    const double reduced = 2 * sigma * (density(fall / 2) - fall / 2 * share) / share;
    EXPECT_NEAR(p.spk, reduced, 2e-4 * sigma);
    EXPECT_NEAR(p.svk, reduced, 2e-4 * sigma);
    // The wrong twin, the secant of the middle 40 % instead of the line, falls 2 t / 0.4.
    EXPECT_GT(std::abs(p.sk - sigma * 2 * t / 0.4), 0.01 * sigma);
}

TEST(MaterialRatio, VolumesOfANormalDistributionHaveTheirClosedForms) {
    const double sigma = 0.002;
    const VolumeParameters p = volume_parameters(MaterialRatioCurve(normal_heights(sigma)));
    // The material above t is density - t tail, the void below it that plus t. The tolerance is 1/n for the points at
    // the ends.
    const auto material = [=](double ratio) {
        const double t = quantile(ratio);
        return sigma * (density(t) - t * ratio);
    };
    const auto empty = [=](double ratio) { return material(ratio) + sigma * quantile(ratio); };
    const double rounding = 2.5e-5 * sigma;
    EXPECT_NEAR(p.vmp, material(0.1), rounding);
    EXPECT_NEAR(p.vmc, material(0.8) - material(0.1), rounding);
    EXPECT_NEAR(p.vvc, empty(0.1) - empty(0.8), rounding);
    EXPECT_NEAR(p.vvv, empty(0.8), rounding);
}

TEST(MaterialRatio, OfATiltedPlaneIsAllCore) {
    const int n = 1000;
    auto map = sampled(n, 3, 1, [](double x, double) { return 0.001 * (x + 0.3); });
    map.height(17, 1) = not_measured;
    const MaterialRatioCurve curve(map);
    const CoreParameters p = core_parameters(curve);
    // The plane falls by n steps of 0.001, less what the one missing point moves.
    EXPECT_NEAR(p.sk, 0.001 * n, 0.001);
    EXPECT_NEAR(p.spk, 0, 0.001);
    EXPECT_NEAR(p.svk, 0, 0.001);
    EXPECT_NEAR(p.smr1, 0, 1e-3);
    EXPECT_NEAR(p.smr2, 1, 1e-3);
    // The volumes are triangles over a tenth and a fifth of the area: 0.1^2 / 2 and 0.2^2 / 2 of the whole fall.
    const VolumeParameters v = volume_parameters(curve);
    EXPECT_NEAR(v.vmp, 0.005, 1e-4);
    EXPECT_NEAR(v.vmc, 0.32 - 0.005, 1e-3);
    EXPECT_NEAR(v.vvc, 0.405 - 0.02, 1e-3);
    EXPECT_NEAR(v.vvv, 0.02, 1e-4);
}

TEST(MaterialRatio, OfATriangleIsThatOfATiltedPlane) {
    // A triangle of 200 points a period passes every height twice a period: levels 1/50 of its amplitude apart.
    const double amplitude = 0.01;
    const auto map = sampled(1000, 2, 1, [=](double x, double) {
        return amplitude * (std::abs(std::fmod(x + 0.3 + 0.5, 200.0) - 100) / 50 - 1);
    });
    const CoreParameters p = core_parameters(MaterialRatioCurve(map));
    EXPECT_NEAR(p.sk, 2 * amplitude, amplitude / 50);
    EXPECT_NEAR(p.smr1, 0, 0.01);
    EXPECT_NEAR(p.smr2, 1, 0.01);
}

TEST(MaterialRatio, OfASinusoidHasItsClosedForm) {
    // The curve is Smc(q) = A cos(pi q), and the volume above the share q is A (sin(pi q) / pi - q cos(pi q)).
    const double amplitude = 0.01;
    const auto map =
        sampled(4000, 1, 1, [=](double x, double) { return amplitude * std::sin(2 * pi * (x + 0.3 + 0.25) / 400); });
    const MaterialRatioCurve curve(map);
    const auto material = [=](double q) { return amplitude * (std::sin(pi * q) / pi - q * std::cos(pi * q)); };
    // Two points stand nearly level: the curve is a stair of 200 treads, wrong by at most a tread of pi A / 200.
    for (const double q : {0.1, 0.5, 0.8})
        EXPECT_NEAR(curve.height(q), amplitude * std::cos(pi * q), amplitude * pi / 200);
    const VolumeParameters p = volume_parameters(curve);
    EXPECT_NEAR(p.vmp, material(0.1), 0.1 * amplitude * pi / 200);
    EXPECT_NEAR(p.vmc, material(0.8) - material(0.1), 0.8 * amplitude * pi / 200);
}

TEST(MaterialRatio, OfASphereCapHasTheVolumeOfItsTop) {
    const double r = 1, a = 0.4;
    const auto map = sampled(803, 803, 1e-3, [=](double x, double y) {
        const double square = std::pow(x + 0.3 - 0.401, 2) + std::pow(y - 0.2 - 0.401, 2);
        return square < a * a ? std::sqrt(r * r - square) : not_measured;
    });
    const MaterialRatioCurve curve(map);
    // A tenth of the base lies below a cap of the height h.
    const double h = r - std::sqrt(r * r - 0.1 * a * a);
    const double lattice = 1e-3; // error of a disc's area on 50 000 points: 50 points
    EXPECT_NEAR(curve.height(0.1), r - h, lattice * h);
    EXPECT_NEAR(volume_parameters(curve).vmp, h * h * (3 * r - h) / 3 / (a * a), 0.1 * 2 * lattice * h);
}

TEST(MaterialRatio, OfAStepHasItsEdgesForParameters) {
    const auto map = sampled(100, 10, 1, [](double x, double) { return x + 0.3 < 69.5 ? 1.0 : 0.0; });
    const CoreParameters p = core_parameters(MaterialRatioCurve(map));
    EXPECT_DOUBLE_EQ(p.sk, 0); // the flattest 40 % lie on the upper plateau
    EXPECT_DOUBLE_EQ(p.spk, 0);
    const VolumeParameters v = volume_parameters(MaterialRatioCurve(map));
    EXPECT_DOUBLE_EQ(v.vmp, 0);
    EXPECT_DOUBLE_EQ(v.vmc, 0.7);
    EXPECT_DOUBLE_EQ(v.vvc, 0.3);
    EXPECT_DOUBLE_EQ(v.vvv, 0);
}

TEST(MaterialRatio, IsUndefinedWithoutMeasuredPoints) {
    const MaterialRatioCurve curve(sampled(4, 4, 1, [](double, double) { return not_measured; }));
    EXPECT_TRUE(std::isnan(curve.height(0.5)));
    EXPECT_TRUE(std::isnan(core_parameters(curve).sk));
    EXPECT_TRUE(std::isnan(volume_parameters(curve).vmp));
}

} // namespace
} // namespace vkfv::surface
