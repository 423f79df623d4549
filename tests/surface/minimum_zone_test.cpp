#include "surface/minimum_zone.hpp"

#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::surface {
namespace {

using namespace test;

constexpr double zone = 0.002;

// The map is flat but for three hills of the zone's height about one pit of depth 0 in the middle of their triangle: no
// tilt lowers the range, since each hill that sinks lifts another. The least-squares plane is tilted by a corner that
// stands out.
TEST(MinimumZone, ThreeHillsAboutAPitHoldTheZone) {
    for (const double tilt : {0.0, 0.02}) {
        HeightMap map = sampled(41, 41, 0.01, [&](double, double) { return 0.4 * zone; });
        map.height(5, 5) = map.height(35, 5) = map.height(20, 35) = zone;
        map.height(20, 15) = 0;
        for (int column = 30; column < 41; ++column)
            for (int row = 20; row < 30; ++row)
                map.height(column, row) = 0.7 * zone;
        for (int row = 0; row < map.rows(); ++row)
            for (int column = 0; column < map.columns(); ++column)
                map.height(column, row) += tilt * map.x(column) - 0.5 * tilt * map.y(row);
        const double across = std::hypot(1, tilt, 0.5 * tilt);
        EXPECT_NEAR(minimum_zone(map), zone / across, 1e-5 * zone) << tilt;
    }
}

// A hill lies between two pits on one line: the zone's planes touch on a line, and the tilt across it is open.
TEST(MinimumZone, OfACylinderIsItsSag) {
    const auto map = sampled(81, 21, 0.005, [&](double x, double) { return zone * std::pow((x + 0.1) / 0.2, 2); });
    EXPECT_NEAR(minimum_zone(map), zone, 1e-5 * zone); // x + 0.1 from -0.2 to 0.2
}

TEST(MinimumZone, OfAPlaneIsNothing) {
    EXPECT_NEAR(minimum_zone(sampled(20, 10, 1, [](double x, double y) { return 0.1 * x - 0.2 * y; })), 0, 1e-12);
    EXPECT_TRUE(std::isnan(minimum_zone(sampled(4, 4, 1, [](double, double) { return not_measured; }))));
}

} // namespace
} // namespace vkfv::surface
