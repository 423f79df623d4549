#include "optics/instrument/field_curvature.hpp"

#include "core/mathematics/units.hpp"
#include "optics/media/medium.hpp"
#include "parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vkfv::optics {
namespace {

// A ball of glass with its stop in the middle has no axis: it sees a sphere about its centre sharply, whose radius is
// the focal length n R / (2 (n - 1)). The ideal tube lens adds nothing.
TEST(FieldCurvature, OfABallIsASphereAboutItsCentre) {
    constexpr double radius = 10, index = 1.5, focal_length = index * radius / (2 * (index - 1));
    auto description = test::ball_microscope(radius, index);
    description.detector_width = 40; // 3 mm in the object
    const auto instrument = assemble(description);
    const FirstOrder& first_order = instrument.first_order;
    ASSERT_NEAR(first_order.efl_objective, focal_length, 1e-9);
    const FieldCurvature curvature = field_curvature(first_order);
    EXPECT_EQ(curvature.height(0, 0), 0);
    const double largest = glm::length(first_order.field_corner);
    ASSERT_GT(largest, 2);
    for (const double r : {0.3 * largest, 0.6 * largest, first_order.field_edge, largest}) {
        // The truth is the height at which the ray from the centre to the plane's point r crosses the sphere.
        const double sphere = focal_length * (1 - std::cos(std::atan(r / focal_length)));
        EXPECT_NEAR(curvature.height(0.6 * r, -0.8 * r), sphere, 0.003 * sphere) << r;
        EXPECT_GT(std::abs(curvature.height(1.01 * r, 0) - sphere), 0.01 * sphere); // wrong twin: another distance
    }
}

// The curvature between edge and corner, and within the edge, is what the trace of a smaller field finds there.
TEST(FieldCurvature, OfAnObjectiveIsWhatSmallerFieldsFind) {
    auto description = test::microscope();
    description.detector_width = 10;
    const auto curvature = field_curvature(assemble(description).first_order);
    for (const double share : {0.3, 0.5, 0.7}) {
        auto smaller = description;
        smaller.detector_width = share * description.detector_width;
        const auto first_order = assemble(smaller).first_order;
        EXPECT_GT(first_order.field_curvature, 0.5e-3); // the edges focus higher
        EXPECT_NEAR(curvature.height(first_order.field_edge, 0), first_order.field_curvature,
                    0.03 * first_order.field_curvature);
        EXPECT_NEAR(curvature.height(first_order.field_corner.x, first_order.field_corner.y),
                    first_order.field_curvature_corner, 0.03 * first_order.field_curvature_corner);
    }
}

// A tilted detector sees a tilted plane of best focus, which is not curved.
TEST(FieldCurvature, OfATiltedDetectorIsThatOfAStraightOne) {
    auto description = test::microscope();
    description.detector_width = 10;
    const auto straight = assemble(description).first_order;
    description.detector_placement.change.tilt_y = 3 * radians_per_degree; // 2.6 um at the edge
    const auto tilted = assemble(description).first_order;
    EXPECT_NEAR(tilted.field_curvature, straight.field_curvature, 0.02 * straight.field_curvature);
    EXPECT_NEAR(tilted.field_curvature_corner, straight.field_curvature_corner, 0.02 * straight.field_curvature_corner);
}

TEST(FieldCurvature, GoesWithoutWhatIsNotTraced) {
    FirstOrder first_order;
    first_order.field_edge = 2;
    first_order.field_corner = {2, 0.1}; // a line camera
    first_order.field_curvature = first_order.field_curvature_corner = 0.008;
    EXPECT_NEAR(field_curvature(first_order).height(1, 0), 0.002, 1e-15);
    first_order.field_corner = {2, 2};
    first_order.field_curvature_corner = std::numeric_limits<double>::quiet_NaN(); // dark
    EXPECT_NEAR(field_curvature(first_order).height(1, 0), 0.002, 1e-15);
    first_order.field_curvature = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(field_curvature(first_order).height(1, 0), 0);
}

} // namespace
} // namespace vkfv::optics
