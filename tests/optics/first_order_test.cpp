#include "optics/train/first_order.hpp"

#include "core/mathematics/units.hpp"
#include "parts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::optics {
namespace {

using test::surface;

// A closed form in double takes a dozen operations: 1e-13 relative.
constexpr double rounding = 1e-13;

TEST(FirstOrder, ThickLensFollowsTheLensmaker) {
    const double n = 1.5168, r1 = 50, r2 = -80, t = 6;
    const std::vector train = {surface(1 / r1, 0, 1, n), surface(1 / r2, t, n, 1)};
    const RayTransfer transfer = transfer_of_train(train);
    const double power = (n - 1) * (1 / r1 - 1 / r2 + (n - 1) * t / (n * r1 * r2));
    EXPECT_NEAR(focal_length(transfer) * power, 1, rounding);
    EXPECT_NEAR(back_focal_distance(transfer), (1 - (n - 1) * t / (n * r1)) / power, 100 * rounding);
    EXPECT_NEAR(front_focal_distance(transfer), (1 + (n - 1) * t / (n * r2)) / power, 100 * rounding);
    EXPECT_NEAR(transfer.a * transfer.d - transfer.b * transfer.c, 1, rounding);
    // The thin-lens formula is the wrong twin: it is off by the thickness' share of the power.
    EXPECT_GT(std::abs(focal_length(transfer) * (n - 1) * (1 / r1 - 1 / r2) - 1), 1e-3);
}

TEST(FirstOrder, BallLens) {
    const double n = 1.5, radius = 2;
    const std::vector train = {surface(1 / radius, 0, 1, n), surface(-1 / radius, 2 * radius, n, 1)};
    const RayTransfer transfer = transfer_of_train(train);
    EXPECT_NEAR(focal_length(transfer), n * 2 * radius / (4 * (n - 1)), 10 * rounding);
    EXPECT_NEAR(back_focal_distance(transfer), focal_length(transfer) - radius, 10 * rounding);
}

// A thin lens of n = 1.5: the curvature is the power.
std::vector<physics::f64::Surface> thin_lens(double focal_length) {
    return {surface(1 / focal_length, 0, 1, 1.5), surface(-1 / focal_length, 0, 1.5, 1)};
}

TEST(FirstOrder, ThinLensImages) {
    const double f = 40;
    const RayTransfer lens = transfer_of_train(thin_lens(f));
    for (const double s : {50.0, 80.0, 400.0, 20.0}) {
        const ParaxialImage image = image_of(lens, s);
        EXPECT_NEAR(1 / image.distance + 1 / s, 1 / f, rounding) << s;
        EXPECT_NEAR(image.magnification, -image.distance / s, 100 * rounding) << s;
    }
}

TEST(FirstOrder, PupilOfAStopBehindALens) {
    const double f = 40;
    for (const double d : {10.0, 25.0, 90.0}) {
        auto train = thin_lens(f);
        train.push_back(surface(0, d, 1, 1));
        const RayTransfer before = transfer_to_surface(train, 2);
        // The lens images the stop to 1/s' = 1/f - 1/d in front of the lens, so s' behind it with the sign
        // turned.
        const double distance = 1 / (1 / d - 1 / f);
        EXPECT_NEAR(entrance_pupil(before).curvature * distance, 1, rounding) << d;
        EXPECT_NEAR(entrance_pupil(before).scale, d, 100 * rounding) << d;
    }
    auto telecentric = thin_lens(f);
    telecentric.push_back(surface(0, f, 1, 1));
    EXPECT_NEAR(entrance_pupil(transfer_to_surface(telecentric, 2)).curvature, 0, rounding);
}

// A fold mirror's frame is turned against those before and behind it, and the axis is as long as without it.
TEST(FirstOrder, AFoldLeavesTheWayItsLength) {
    const auto lens_at = [](double z, double curvature) {
        PlacedSurface placed;
        placed.surface = surface(curvature, 0, 1, 1.5);
        placed.pose = Pose{}.along_z(z);
        return placed;
    };
    PlacedSurface mirror;
    mirror.surface = surface(0, 0, 1.5, 1.5);
    mirror.pose = Pose{}.along_z(50).turned({.tilt_x = 0.25 * pi});
    PlacedSurface last = lens_at(120, -0.01);
    std::swap(last.surface.index_before, last.surface.index_after);
    std::vector<PlacedSurface> straight = {lens_at(0, 0.02), last};
    std::vector<PlacedSurface> folded = {lens_at(0, 0.02), mirror, last};
    link(straight, Pose{});
    link(folded, Pose{});
    const RayTransfer expected = transfer_of_train(surfaces_of(straight));
    const RayTransfer seen = transfer_of_train(surfaces_of(folded));
    EXPECT_NEAR(seen.b, expected.b, 1e-12);
    EXPECT_NEAR(seen.c, expected.c, 1e-14);
    EXPECT_NEAR(seen.d, expected.d, 1e-12);
}

} // namespace
} // namespace vkfv::optics
