// The lateral scales of a cross grating that is distorted and sheared by known amounts.
#include "dimensions/lattice_nodes.hpp"

#include "core/mathematics/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace vkfv::dimensions {
namespace {

constexpr double period = 0.02, radius = 0.3; // mm

// A cross grating with steep flanks, 0.66 mm wide in pixels of 1 um, whose place (u, v) is seen at (x, y).
surface::HeightMap seen(const std::function<glm::dvec2(double x, double y)>& place) {
    constexpr int side = 660;
    constexpr double pitch = 0.001, depth = 0.003;
    surface::HeightMap map{.height = Grid<double>(side, side),
                           .x0 = -0.5 * (side - 1) * pitch,
                           .y0 = -0.5 * (side - 1) * pitch,
                           .pitch_x = pitch,
                           .pitch_y = pitch};
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const glm::dvec2 at = place(map.x(column), map.y(row));
            const auto line = [](double u) { return 0.5 + 0.5 * std::tanh(3 * std::cos(2 * pi * u / period)); };
            map.height(column, row) = depth * (line(at.x) * line(at.y) - 1);
        }
    }
    return map;
}

const CrossGrating grating{.frame = {}, .pitch_u = period, .pitch_v = period, .angle = 0.5 * pi};

std::optional<LatticeMap> map_within_disc(const surface::HeightMap& map) {
    auto nodes = lattice_nodes(map, grating);
    std::erase_if(nodes, [](const LatticeNode& node) { return std::hypot(node.u, node.v) > radius; });
    return lattice_map(nodes);
}

// A radial distortion of 0.15 % at the radius moves the rim by 0.45 um. Over a disc the least-squares scale of k r^3 is
// 2/3 k R^2, so that the amplification is 1.0010 and a third of the 0.45 um is left at the rim.
TEST(LatticeNodes, FindADistortionAsItsClosedFormSays) {
    constexpr double at_rim = 0.0015;
    const auto distorted = map_within_disc(seen([](double x, double y) {
        // The inverse of r (1 + k r^2), by Newton's rule.
        const double k = at_rim / (radius * radius), r = std::hypot(x, y);
        double from = r;
        for (int step = 0; step < 4; ++step) {
            from -= (from * (1 + k * from * from) - r) / (1 + 3 * k * from * from);
        }
        return r > 0 ? glm::dvec2(x, y) * (from / r) : glm::dvec2(0);
    }));
    ASSERT_TRUE(distorted);
    EXPECT_NEAR(distorted->amplification_u, 1 + 2.0 / 3 * at_rim, 0.04e-3);
    EXPECT_NEAR(distorted->amplification_v, 1 + 2.0 / 3 * at_rim, 0.04e-3);
    EXPECT_NEAR(distorted->largest_deviation, at_rim * radius / 3, 0.015e-3);
    EXPECT_NEAR(distorted->perpendicularity, 0, 1e-6);
}

TEST(LatticeNodes, FindShearAndScalesToTheirDigits) {
    const double shear = std::tan(0.1 * radians_per_degree);
    const auto sheared = map_within_disc(seen([&](double x, double y) {
        const double v = y / 0.9995;
        return glm::dvec2((x - shear * y) / 1.0003, v); // the seen y axis leans by the angle of the shear towards x
    }));
    ASSERT_TRUE(sheared);
    EXPECT_NEAR(sheared->amplification_u, 1.0003, 1e-6);
    EXPECT_NEAR(sheared->amplification_v, 0.9995, 1e-6);
    EXPECT_NEAR(sheared->perpendicularity / radians_per_degree, -0.1, 1e-4);
    EXPECT_LT(sheared->largest_deviation, 1e-6);
    // The wrong twin, an undistorted image, has none of this.
    const auto plain = map_within_disc(seen([](double x, double y) { return glm::dvec2(x, y); }));
    ASSERT_TRUE(plain);
    EXPECT_NEAR(plain->amplification_u, 1, 1e-6);
    EXPECT_NEAR(plain->perpendicularity / radians_per_degree, 0, 1e-4);
}

TEST(LatticeNodes, StandOnlyWhereTheirNeighbourhoodIsMeasured) {
    auto map = seen([](double x, double y) { return glm::dvec2(x - 0.0012, y + 0.0007); });
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns() / 2; ++column) {
            map.height(column, row) = surface::undefined;
        }
    }
    const auto nodes = lattice_nodes(map, grating);
    ASSERT_GT(nodes.size(), 100u);
    for (const auto& node : nodes) {
        EXPECT_GT(node.u, 0);
        // Beside the gap and the borders a hundredth of the neighbourhood may be missing.
        const bool inside = node.u > 1.5 * period && std::abs(node.v) < 0.29;
        EXPECT_NEAR(node.off_u, 0.0012, inside ? 1e-6 : 5e-5);
        EXPECT_NEAR(node.off_v, -0.0007, inside ? 1e-6 : 5e-5);
    }
}

} // namespace
} // namespace vkfv::dimensions
