#include "topography/slope_deviation.hpp"

#include "core/mathematics/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace vkfv::topography {
namespace {

using surface::HeightMap;

constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();
constexpr double radius = 1;

// The slope angle of a sphere at the distance r from its axis is asin(r / radius). `height` takes that angle.
template <class Function>
HeightMap over_angles(const Function& height) {
    HeightMap map{.height = Grid<double>(401, 401), .x0 = -1, .y0 = -1, .pitch_x = 0.005, .pitch_y = 0.005};
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            const double share = std::hypot(map.x(column), map.y(row)) / radius;
            map.height(column, row) =
                share < std::sin(61 * radians_per_degree) ? height(std::asin(share)) : not_measured;
        }
    return map;
}

TEST(SlopeDeviation, OfASphereIsBinnedByItsAngle) {
    const HeightMap truth = over_angles([](double angle) { return radius * std::cos(angle); });
    // The deviation in mm is the angle in radians; steeper than 40 degrees nothing is measured, and of 30 to 40 degrees
    // half.
    int parity = 0;
    const HeightMap deviation = over_angles([&](double angle) {
        const double degrees = angle / radians_per_degree;
        return degrees > 40 || (degrees > 30 && ++parity % 2 == 0) ? not_measured : angle;
    });
    const double width = 10 * radians_per_degree;
    const auto bins = deviation_by_slope(deviation, truth, width);
    ASSERT_EQ(bins.size(), 7u); // 60 to 61 degrees too
    for (int k = 0; k < 6; ++k) {
        const auto& bin = bins[static_cast<std::size_t>(k)];
        EXPECT_NEAR(bin.from, k * width, 1e-12);
        EXPECT_NEAR(bin.to, (k + 1) * width, 1e-12);
        // The points are those of the ring's area. A ring of the radius r loses or gains some of the 2 pi r / pitch
        // points on its rims: 2 % at the least ring's 3800 points by chance. Central differences bend the slope by
        // pitch^2 z''' / 6, at most 2e-4 here.
        const double area = pi * (std::pow(std::sin(bin.to), 2) - std::pow(std::sin(bin.from), 2));
        EXPECT_NEAR(bin.points, area / (0.005 * 0.005), 0.02 * bin.points);
        EXPECT_NEAR(bin.measured_share, k < 3 ? 1 : k == 3 ? 0.5 : 0, 0.02);
        if (k < 4) {
            // The mean angle over the ring is the integral of angle sin cos over that of sin cos, and that of its
            // square likewise.
            double weight = 0, sum = 0, squares = 0;
            for (int i = 0; i < 1000; ++i) {
                const double angle = bin.from + width * (i + 0.5) / 1000, w = std::sin(angle) * std::cos(angle);
                weight += w;
                sum += w * angle;
                squares += w * angle * angle;
            }
            EXPECT_NEAR(bin.bias, sum / weight, 0.01 * width);
            EXPECT_NEAR(bin.rms, std::sqrt(squares / weight), 0.01 * width);
        } else {
            EXPECT_TRUE(std::isnan(bin.bias));
        }
    }
}

TEST(SlopeDeviation, NeedsOneGridAndAWidth) {
    const HeightMap map = over_angles([](double) { return 0.0; });
    HeightMap other = map;
    other.height = Grid<double>(3, 3);
    EXPECT_THROW(deviation_by_slope(map, other, 0.1), std::invalid_argument);
    EXPECT_THROW(deviation_by_slope(map, map, 0), std::invalid_argument);
}

} // namespace
} // namespace vkfv::topography
