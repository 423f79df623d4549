#include "surface/feature_parameters.hpp"

#include "core/mathematics/units.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::surface {
namespace {

using namespace test;

constexpr double amplitude = 0.001, pitch = 0.0005;
constexpr int points_a_period = 20, periods = 5;
constexpr double period = points_a_period * pitch;

// Peaks and pits lie on points of the grid, with whole periods and pits at the borders, so that no peak is cut in
// halves.
HeightMap egg_box(double offset = 0) {
    HeightMap map{.height = Grid<double>(points_a_period * periods, points_a_period * periods),
                  .x0 = 0,
                  .y0 = 0,
                  .pitch_x = pitch,
                  .pitch_y = pitch};
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            map.height(column, row) = offset - amplitude * (std::cos(2 * pi * column / points_a_period) +
                                                            std::cos(2 * pi * row / points_a_period));
    return map;
}

TEST(FeatureParameters, OfAnEggBoxHaveTheirClosedForms) {
    const auto p = feature_parameters(egg_box(0.3));
    EXPECT_NEAR(p.s5p, 2 * amplitude, 1e-12);
    EXPECT_NEAR(p.s5v, 2 * amplitude, 1e-12);
    EXPECT_NEAR(p.s10z, 4 * amplitude, 1e-12);
    EXPECT_NEAR(p.spd, 1 / (period * period), 1e-9 / (period * period)); // a peak a period
    // The curvature is by central differences of a cosine, along x and along y; for ever finer points it is 2 pi /
    // period squared.
    const double curvature = amplitude * 2 * (1 - std::cos(2 * pi / points_a_period)) / (pitch * pitch);
    EXPECT_NEAR(p.spc, curvature, 1e-8 * curvature);
    EXPECT_NEAR(p.spc, amplitude * std::pow(2 * pi / period, 2), 0.01 * curvature);
}

// The map has a lesser peak that rises by a share of Sz over the saddle to the higher one.
TEST(FeatureParameters, APeakCountsFromFivePercentOfSzOn) {
    for (const double rise : {0.04, 0.06}) {
        HeightMap map = sampled(40, 9, 1, [](double, double) { return 0.0; });
        const auto set = [&](int column, double z) {
            for (int row = 3; row <= 5; ++row)
                map.height(column, row) = z;
        };
        for (int column = 8; column <= 30; ++column)
            set(column, 0.5);
        set(10, 1); // the highest
        set(20, 0.5 + rise);
        const auto p = feature_parameters(map);
        EXPECT_NEAR(p.spd, (rise < 0.05 ? 1 : 2) / 360.0, 1e-12) << rise;
        EXPECT_NEAR(feature_parameters(map, 0.01).spd, 2 / 360.0, 1e-12) << rise;
    }
}

TEST(FeatureParameters, GapsMakeNoPeaksOfNoise) {
    HeightMap map = egg_box();
    forget_a_third(map);
    const auto p = feature_parameters(map);
    EXPECT_NEAR(p.s10z, 4 * amplitude, 0.05 * 4 * amplitude);
    EXPECT_TRUE(std::isnan(feature_parameters(sampled(5, 5, 1, [](double, double) { return not_measured; })).spd));
}

TEST(FeatureParameters, ALevelMapHasNoHeight) {
    EXPECT_EQ(feature_parameters(sampled(6, 5, 1, [](double, double) { return 2.0; })).s10z, 0);
}

} // namespace
} // namespace vkfv::surface
