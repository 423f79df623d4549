#include "dimensions/find_sphere.hpp"

#include "dimensions/find.hpp"
#include "dimensions/made_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::dimensions {
namespace {

using namespace test;
using surface::HeightMap;

// The upper side of a sphere that stands out of the level ground by a rim of this radius, mm.
double cap_height(double radius, double rim, double u, double v) {
    const double square = u * u + v * v;
    return square < rim * rim ? std::sqrt(radius * radius - square) - std::sqrt(radius * radius - rim * rim) : 0;
}

// The noise is a fortieth of the sag: a threshold of height, or all points near the first sphere, would take in the
// ground.
TEST(FindSphere, TheCapOfAStandardInNoise) {
    const Frame frame{.x = -0.02, .y = 0.01};
    for (const double side : {1.0, -1.0}) {
        const auto map = made(frame, [&](double u, double v) { return side * cap_height(0.2, 0.04, u, v); },
                              {.tilt_x = 0.01, .tilt_y = -0.006, .noise = 1e-4, .gaps = 0.1});
        const auto cap = found_sphere(map);
        ASSERT_TRUE(cap);
        // The rim's middle stands to a tenth of a point of 0.002 mm and its uncertainty in noise.
        EXPECT_NEAR(cap->frame.x, frame.x, 5e-4);
        EXPECT_NEAR(cap->frame.y, frame.y, 5e-4);
        const auto found = evaluate_found(map, Sought::sphere);
        ASSERT_EQ(found.size(), 3u);
        EXPECT_LE(std::abs(found[0].value - 0.2), 3 * found[0].standard_error);
        EXPECT_LT(found[0].standard_error, 2e-3);
        EXPECT_NEAR(found[2].value, 1e-4, 1e-5);
    }
}

TEST(FindSphere, ACapWhoseRimLeavesOnlyTheCornersToTheGround) {
    const Frame frame{.x = -0.01, .y = 0.01};
    const auto found = evaluate_found(
        made(frame, [](double u, double v) { return cap_height(1, 0.2, u, v); }, {.noise = 1e-4}), Sought::sphere);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_LE(std::abs(found[0].value - 1), 3 * found[0].standard_error);
}

// A sphere of metres with an uncertainty as large would fit each of these.
TEST(FindSphere, NoneInOtherStandards) {
    const Disturbance noisy{.tilt_x = 0.01, .noise = 5e-5};
    const std::vector<HeightMap> others{
        made(
            {}, [](double, double) { return 0.0; }, noisy),
        made(
            {.x = 0.01}, [](double u, double) { return u > 0 ? 0.002 : 0.0; }, noisy),
        made(
            {}, [](double u, double) { return std::abs(u) < 0.03 ? -0.002 : 0.0; }, noisy),
        made(
            {}, [](double u, double) { return 0.001 * std::cos(2 * 180 * degrees * u / 0.05); }, noisy),
        made(
            {}, [](double u, double) { return u * u; }, noisy)};
    for (std::size_t k = 0; k < others.size(); ++k) {
        for (const auto& one : evaluate_found(others[k], Sought::sphere))
            EXPECT_TRUE(std::isnan(one.value)) << k << ": " << one.value;
    }
}

} // namespace
} // namespace vkfv::dimensions
