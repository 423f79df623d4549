#include "optics/prescriptions/pose.hpp"

#include "core/mathematics/units.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::optics {
namespace {

constexpr double angle = 0.3;

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double tolerance = 1e-15) {
    EXPECT_NEAR(found.x, expected.x, tolerance);
    EXPECT_NEAR(found.y, expected.y, tolerance);
    EXPECT_NEAR(found.z, expected.z, tolerance);
}

// By the sentence of prescription.hpp, positive tilts turn z towards -y, z towards x, x towards y.
TEST(Pose, TiltsRightHanded) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    expect_near(Pose{}.turned({.tilt_x = angle}).axes[2], {0, -s, c});
    expect_near(Pose{}.turned({.tilt_x = angle}).axes[1], {0, c, s});
    expect_near(Pose{}.turned({.tilt_y = angle}).axes[2], {s, 0, c});
    expect_near(Pose{}.turned({.tilt_y = angle}).axes[0], {c, 0, -s});
    expect_near(Pose{}.turned({.tilt_z = angle}).axes[0], {c, s, 0});
    expect_near(Pose{}.turned({.tilt_z = angle}).axes[1], {-s, c, 0});
}

// Turns are about the new axes: the second turn leaves the axis that the first has brought, not the first frame's.
TEST(Pose, TiltsAboutTheNewAxesInOrder) {
    const CoordinateBreak change{
        .decentre_x = 1, .decentre_y = 2, .tilt_x = 0.2, .tilt_y = 0.4, .tilt_z = 0.7, .thickness = 5};
    const Pose steps = Pose{{1, 2, 0}}.turned({.tilt_x = 0.2}).turned({.tilt_y = 0.4}).turned({.tilt_z = 0.7});
    const Pose once = Pose{}.turned(change);
    const Pose other_order = Pose{}.turned({.tilt_z = 0.7}).turned({.tilt_y = 0.4}).turned({.tilt_x = 0.2});
    for (int axis = 0; axis < 3; ++axis) {
        expect_near(once.axes[axis], steps.axes[axis]);
        EXPECT_GT(glm::length(once.axes[axis] - other_order.axes[axis]), 0.05); // the wrong twin
    }
    expect_near(once.origin, {1, 2, 0}); // the decentre comes before the tilts
    expect_near(Pose{}.after(change).origin, glm::dvec3(1, 2, 0) + 5.0 * once.axes[2]);

    CoordinateBreak first = change;
    first.tilt_first = true;
    const Pose tilted = Pose{}.turned(first);
    for (int axis = 0; axis < 3; ++axis) {
        expect_near(tilted.axes[axis], other_order.axes[axis]);
    }
    expect_near(tilted.origin, tilted.axes * glm::dvec3(1, 2, 0));
}

// A break of the same numbers with their signs changed and in reversed order brings the frame back.
TEST(Pose, IsRestoredByTheReturnBreak) {
    const Pose start = Pose{{3, -1, 7}}.turned({.tilt_x = 0.5, .tilt_y = -0.2});
    const CoordinateBreak change{.decentre_x = 1, .decentre_y = 2, .tilt_x = 0.2, .tilt_y = 0.4, .tilt_z = 0.7};
    const CoordinateBreak back{
        .decentre_x = -1, .decentre_y = -2, .tilt_x = -0.2, .tilt_y = -0.4, .tilt_z = -0.7, .tilt_first = true};
    const Pose restored = start.turned(change).turned(back);
    expect_near(restored.origin, start.origin, 4e-15);
    for (int axis = 0; axis < 3; ++axis) {
        expect_near(restored.axes[axis], start.axes[axis], 4e-16);
    }
    CoordinateBreak wrong = back;
    wrong.tilt_first = false;
    EXPECT_GT(glm::length(start.turned(change).turned(wrong).axes[0] - start.axes[0]), 0.01);
}

TEST(Pose, OfAMirrorsImage) {
    const Pose mirror = Pose{{0, 0, 10}}.turned({.tilt_x = pi / 4});
    const Pose beyond = Pose{{0.5, 0, 30}};
    const Pose image = beyond.mirrored_in(mirror);
    // A mirror of 45 degrees whose normal leans to -y folds +z to +y.
    expect_near(image.origin, {0.5, 20, 10}, 1e-14);
    expect_near(image.axes[2], {0, 1, 0}, 1e-15);
    expect_near(image.axes[0], {1, 0, 0}, 1e-15);
    EXPECT_NEAR(glm::determinant(image.axes), -1, 1e-15);
    const Pose back = image.mirrored_in(mirror);
    expect_near(back.origin, beyond.origin, 1e-14);
    for (int axis = 0; axis < 3; ++axis) {
        expect_near(back.axes[axis], beyond.axes[axis], 1e-15);
    }
    // Points of the mirror stay.
    const Pose on = mirror.place(Pose{{2, -3, 0}});
    expect_near(on.mirrored_in(mirror).origin, on.origin, 1e-14);
}

TEST(Pose, PlacesAndTurnsHalfRound) {
    const Pose outer = Pose{{1, 2, 3}}.turned({.tilt_x = 0.3, .tilt_y = 0.1});
    const Pose inner = Pose{{-1, 0.5, 2}}.turned({.tilt_z = 0.4});
    const glm::dvec3 point(0.2, 0.3, 0.4);
    expect_near(outer.place(inner).point(point), outer.point(inner.point(point)), 1e-14);
    expect_near(outer.place(inner).direction(point), outer.direction(inner.direction(point)), 1e-15);
    const Pose half = outer.half_turn();
    expect_near(half.axes[0], outer.axes[0]);
    expect_near(half.axes[1], -outer.axes[1]);
    expect_near(half.axes[2], -outer.axes[2]);
    EXPECT_NEAR(glm::determinant(half.axes), 1, 1e-15);
}

} // namespace
} // namespace vkfv::optics
