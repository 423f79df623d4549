#include "dimensions/levels.hpp"

#include "dimensions/made_maps.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace vkfv::dimensions {
namespace {

using namespace test;
using surface::HeightMap;

TEST(Levels, AGrooveTiltedTurnedAndWithGapsHasItsDepthAndWidth) {
    for (const double angle : {0.0, 12.0, 90.0, -37.0}) {
        const Groove groove{.frame = {.x = 0.004, .y = 0.007, .angle = angle * degrees}, .width = 0.06, .depth = 0.005};
        const HeightMap map = made(groove.frame, [&](double u, double) { return groove_height(groove, 0.006, u); },
                                   {.tilt_x = 0.01, .tilt_y = -0.02, .gaps = 0.2});
        const auto depth = groove_depth(map, groove);
        ASSERT_TRUE(depth) << angle;
        // A profile is a strip as wide as a point: the tilt along v remains in it where the frame is turned.
        EXPECT_NEAR(depth->areal, groove.depth, 1e-12) << angle;
        EXPECT_NEAR(depth->profiles.mean, groove.depth, 1e-5 * (angle == 0 || angle == 90 ? 1e-7 : 1)) << angle;
        EXPECT_NEAR(depth->slope_u, 0.01 * std::cos(angle * degrees) - 0.02 * std::sin(angle * degrees), 1e-9);
        const auto width = groove_width(map, groove, *depth);
        ASSERT_TRUE(width);
        EXPECT_NEAR(width->mean, groove.width, 4e-5)
            << angle; // a fiftieth of a pitch: gaps at the flank's ends are bridged
    }
}

TEST(Levels, ARidgeHasItsHeight) {
    const Groove ridge{.frame = {.angle = 5 * degrees}, .width = 0.05, .depth = -0.002};
    const auto height = groove_depth(
        made(ridge.frame, [&](double u, double) { return groove_height(ridge, 0.004, u); }, {.tilt_x = 0.03}), ridge);
    ASSERT_TRUE(height);
    EXPECT_NEAR(height->areal, 0.002, 1e-12);
}

// ISO 5436-1 leaves out the regions beside the edges because they may be rounded: with corners rounded over a fifth of
// the width the evaluated regions see nothing of them, while levels from all points are off by a tenth.
TEST(Levels, RoundedEdgesDoNotCount) {
    const Groove groove{.frame = {}, .width = 0.06, .depth = 0.005};
    const HeightMap map =
        made(groove.frame, [&](double u, double) { return groove_height(groove, 0.6 * groove.width, u); });
    EXPECT_NEAR(groove_depth(map, groove)->areal, groove.depth, 1e-12);
    // The wrong twin: everything within half the width is the groove, everything outside it the level.
    double inside = 0, inside_count = 0, outside = 0, outside_count = 0;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            const bool in = std::abs(map.x(column)) < groove.width / 2;
            (in ? inside : outside) += map.height(column, row);
            (in ? inside_count : outside_count) += 1;
        }
    EXPECT_LT(outside / outside_count - inside / inside_count, 0.9 * groove.depth);
}

TEST(Levels, NoiseIsToldByTheStandardError) {
    const Groove groove{.frame = {}, .width = 0.06, .depth = 0.005};
    double sum = 0, told = 0;
    const int draws = 25;
    for (unsigned seed = 1; seed <= draws; ++seed) {
        const auto depth =
            groove_depth(made(groove.frame, [&](double u, double) { return groove_height(groove, 0.004, u); },
                              {.noise = 2e-4, .seed = seed}),
                         groove);
        const double deviation = depth->profiles.mean - groove.depth;
        sum += deviation * deviation;
        told += depth->profiles.standard_error * depth->profiles.standard_error;
    }
    // Chi-square of 25 degrees of freedom, over these, lies between both bounds with 99.8 %.
    EXPECT_GT(sum / told, 1 / 2.7);
    EXPECT_LT(sum / told, 2.3);
}

TEST(Levels, CorrelatedProfilesCountAsFewer) {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    double scatter = 0, told = 0, of_independent_values = 0;
    for (int draw = 0; draw < 300; ++draw) {
        std::vector<double> white(408), window;
        std::ranges::generate(white, [&] { return normal(random); });
        for (std::size_t k = 0; k + 8 < white.size(); ++k) {
            double sum = 0;
            for (std::size_t j = 0; j < 8; ++j)
                sum += white[k + j] / 8;
            window.push_back(sum);
        }
        const Mean mean = mean_of(window);
        scatter += mean.mean * mean.mean / 300;
        told += mean.standard_error * mean.standard_error / 300;
        double variance = 0;
        for (const double value : window) {
            variance += (value - mean.mean) * (value - mean.mean) / static_cast<double>(window.size() - 1);
        }
        of_independent_values += variance / static_cast<double>(window.size()) / 300;
    }
    EXPECT_NEAR(told / scatter, 1, 0.35);
    // The wrong twin is s / sqrt(n), whose variance is an eighth of the means'.
    EXPECT_LT(of_independent_values / scatter, 1 - 0.35);
}

TEST(Levels, AnEdgeAloneHasItsHeight) {
    const Step step{.frame = {.x = 0.01, .y = 0.005, .angle = 20 * degrees}, .height = -0.008};
    const HeightMap map =
        made(step.frame, [&](double u, double) { return step.height * std::clamp(u / 0.004, -0.5, 0.5); },
             {.tilt_x = 0.02, .tilt_y = 0.01, .gaps = 0.3});
    const auto height = step_height(map, step);
    ASSERT_TRUE(height);
    EXPECT_NEAR(height->areal, step.height, 1e-12);
}

TEST(Levels, WhatTheMapDoesNotCoverHasNoHeight) {
    const Groove wide{.frame = {}, .width = 0.3, .depth = 0.005};
    EXPECT_FALSE(groove_depth(made({}, [&](double u, double) { return groove_height(wide, 0.004, u); }), wide));
    const Groove groove{.frame = {}, .width = 0.06, .depth = 0.005};
    HeightMap map = made({}, [&](double u, double) { return groove_height(groove, 0.004, u); });
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (std::abs(map.x(column)) < groove.width / 2)
                map.height(column, row) = surface::undefined;
    EXPECT_FALSE(groove_depth(map, groove)) << "no bottom";
    EXPECT_FALSE(step_height(map, {.frame = {.x = 5}, .height = 1})) << "no edge";
}

TEST(Levels, LinesOfAGrating) {
    const Grating grating{.frame = {.angle = 8 * degrees}, .period = 0.04, .depth = 0.003, .line_width = 0.016};
    const HeightMap map =
        made(grating.frame,
             [&](double u, double) {
                 const double t = std::abs(u - grating.period * std::round(u / grating.period));
                 return -grating.depth * std::clamp((t - grating.line_width / 2) / 0.002 + 0.5, 0.0, 1.0);
             },
             {.tilt_x = 0.01, .gaps = 0.1});
    const auto depth = line_depth(map, grating);
    ASSERT_TRUE(depth);
    EXPECT_NEAR(depth->areal, grating.depth, 1e-12);
}

TEST(Levels, PlateausOfAnyOutline) {
    // A bar and a disc stand at different heights.
    const auto height = [](double u, double v) {
        return std::abs(u + 0.1) < 0.02 ? 0.004 : std::hypot(u - 0.08, v) < 0.04 ? 0.009 : 0.0;
    };
    Plateaus plateaus{
        .nominal = {.height = Grid<double>(401, 401), .x0 = -0.2, .y0 = -0.2, .pitch_x = 0.001, .pitch_y = 0.001}};
    for (int row = 0; row < 401; ++row)
        for (int column = 0; column < 401; ++column)
            plateaus.nominal.height(column, row) = height(plateaus.nominal.x(column), plateaus.nominal.y(row));
    const auto found =
        plateau_heights(made({}, height, {.tilt_x = 0.01, .tilt_y = 0.03, .noise = 1e-5, .gaps = 0.2}), plateaus);
    ASSERT_EQ(found.size(), 2u);
    for (const auto& one : found) {
        EXPECT_LT(std::abs(one.height - one.nominal), 5 * one.standard_error);
        EXPECT_LT(one.standard_error, 2e-6);
    }
    EXPECT_EQ(found[0].nominal, 0.004);
}

} // namespace
} // namespace vkfv::dimensions
