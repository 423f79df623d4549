// The rays that the bench times must be those that it describes: the share that meets the specimen, by a quadrature
// over places and directions, shows whether they are.
#include "bench/hit_times.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace vkfv::bench {
namespace {

// The specimen is flat at z = 0 and 0.2 mm wide, except for one point far up in a corner, to which the top plane rises.
specimen::Specimen plain(double top) {
    specimen::HeightField field;
    field.heights = Grid<float>(129, 129);
    field.pitch_x = field.pitch_y = 0.2 / 128;
    field.x_min = field.y_min = -0.1;
    field.heights(0, 0) = static_cast<float>(top);
    return {field, {}};
}

trace::TraceOptions options(trace::Traversal traversal) {
    trace::TraceOptions result;
    result.traversal = traversal;
    result.batch = 1 << 18;
    return result;
}

// Share of rays from the height `top`, uniform over the footprint and over the pupil, that come down within it.
double share_within(double top, double side, double aperture) {
    double sum = 0;
    constexpr int steps = 400;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const double sine = aperture * std::sqrt((i + 0.5) / steps);
            const double angle = 2 * std::numbers::pi * (j + 0.5) / steps;
            const double across = top * sine / std::sqrt(1 - sine * sine);
            sum += (1 - across * std::abs(std::cos(angle)) / side) * (1 - across * std::abs(std::sin(angle)) / side);
        }
    }
    return sum / (steps * steps);
}

TEST(HitTimes, TimesTheRaysThatItSays) {
    const double share = share_within(0.05, 0.2, 0.4);
    // The tolerance is four standard errors of 2^18 rays, beyond which 1 in 16'000 chances falls; the spike, half a
    // cell wide in the mean, catches less than its shadow of some that would leave.
    const double tolerance = 4 * std::sqrt(share * (1 - share) / (1 << 18)) + 0.05 * 0.4 * 0.5 / 128 / 0.2;
    ASSERT_GT(std::abs(share_within(0.05, 0.2, 0.35) - share), 2 * tolerance); // another aperture stands out
    for (const trace::Traversal traversal :
         {trace::Traversal::quadtree, trace::Traversal::ray_query, trace::Traversal::bvh}) {
        for (const HitOrder order : {HitOrder::random, HitOrder::morton}) {
            const HitTimes times = time_hits(plain(0.05), options(traversal), 0.4, order, 2);
            EXPECT_NEAR(times.share_met, share, tolerance);
            EXPECT_EQ(times.rays, 1u << 18);
            EXPECT_GT(times.hits_per_second, 0);
            EXPECT_GE(times.spread, 0);
        }
        // From a plane nothing comes back.
        EXPECT_EQ(time_hits(plain(0), options(traversal), 0.4, HitOrder::leaving, 1).share_met, 0);
        // Rays that start within rounding of a side may leave by it: a draw's last cell is 2^-21 of each of four sides.
        EXPECT_NEAR(time_hits(plain(0), options(traversal), 0.4, HitOrder::random, 1).share_met, 1, 2e-5);
    }
}

} // namespace
} // namespace vkfv::bench
