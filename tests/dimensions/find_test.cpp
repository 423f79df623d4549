#include "dimensions/find.hpp"

#include "dimensions/made_maps.hpp"

#include <gtest/gtest.h>

namespace vkfv::dimensions {
namespace {

using namespace test;
using surface::HeightMap;

constexpr Disturbance rough{.tilt_x = 0.01, .tilt_y = -0.006, .noise = 5e-5, .gaps = 0.1};

TEST(Find, AGrooveWhereverItLies) {
    for (const double angle : {0.0, 63.0, -21.5}) {
        const Groove groove{.frame = {.x = 0.012, .y = 0.006, .angle = angle * degrees}, .width = 0.05, .depth = 0.004};
        const auto found =
            evaluate_found(made(
                               groove.frame, [&](double u, double) { return groove_height(groove, 0.004, u); }, rough),
                           Sought::groove);
        ASSERT_EQ(found.size(), 3u) << angle;
        EXPECT_NEAR(found[0].value, groove.depth, 2e-5) << angle;
        EXPECT_NEAR(found[1].value, groove.depth, 1e-5) << angle;
        EXPECT_NEAR(found[2].value, groove.width, 4e-4) << angle;
        EXPECT_TRUE(std::isnan(found[0].nominal));
    }
}

TEST(Find, AnEdgeOffTheMiddle) {
    const Step step{.frame = {.x = 0.03, .y = 0.01, .angle = 40 * degrees}, .height = 0.006};
    const auto found =
        evaluate_found(made(
                           step.frame, [&](double u, double) { return u > 0 ? step.height : 0.0; }, rough),
                       Sought::step);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_NEAR(std::abs(found[1].value), step.height, 2e-5);
}

TEST(Find, ASphereOnAPlaneAndOneThatFillsTheField) {
    for (const double height : {0.03, -0.03, 0.14}) {
        const SphereCap cap{.frame = {.x = -0.01, .y = 0.01}, .radius = height == 0.14 ? 1.0 : 0.2, .height = height};
        const auto found = evaluate_found(made(cap.frame,
                                               [&](double u, double v) {
                                                   const double depth = std::abs(cap.height);
                                                   const double z =
                                                       depth - cap.radius +
                                                       std::sqrt(cap.radius * cap.radius -
                                                                 std::min(u * u + v * v, cap.radius * cap.radius));
                                                   return (cap.height < 0 ? -1 : 1) * std::max(0.0, z);
                                               },
                                               {.noise = 2e-5, .gaps = 0.2}),
                                          Sought::sphere);
        ASSERT_EQ(found.size(), 3u);
        EXPECT_NEAR(found[0].value, cap.radius, 0.002 * cap.radius) << height;
        EXPECT_NEAR(found[2].value, 2e-5, 3e-6) << height;
    }
}

TEST(Find, WavesAndLines) {
    const Frame frame{.angle = 25 * degrees};
    const auto wave = evaluate_found(
        made(
            frame, [](double u, double) { return 0.001 * std::sin(2 * 180 * degrees * u / 0.047); }, rough),
        Sought::sinusoid);
    ASSERT_EQ(wave.size(), 2u);
    EXPECT_NEAR(wave[0].value, 0.001, 3e-6);
    EXPECT_NEAR(wave[1].value, 0.047, 1e-5);
    const auto lines = evaluate_found(
        made(
            frame, [](double u, double) { return std::abs(u - 0.04 * std::round(u / 0.04)) < 0.007 ? 0.003 : 0.0; },
            rough),
        Sought::grating);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_NEAR(lines[0].value, 0.04, 4e-5);
    EXPECT_NEAR(lines[2].value, 0.003, 1e-5);
}

TEST(Find, NothingInALevelMap) {
    for (const Sought sought :
         {Sought::step, Sought::groove, Sought::sinusoid, Sought::grating, Sought::cross_grating, Sought::sphere})
        for (const auto& one : evaluate_found(made({}, [](double, double) { return 0.0; }, {.gaps = 1}), sought))
            EXPECT_TRUE(std::isnan(one.value)) << one.name;
}

} // namespace
} // namespace vkfv::dimensions
