// The filters of the field's tiles are near Hopkins' integral at points all over a field of 1 mm.
#include "optics/waves/filter_error.hpp"

#include "../parts.hpp"
#include "core/mathematics/units.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vkfv::optics {
namespace {

struct Worst {
    double error = 0;
    double integral = 0; // of the error's transfer function against that of the integral
};

// Points of the field, some on tiles and some between them, as shares of the half field.
const std::vector<glm::dvec2> ten_points = {glm::dvec2(0), {1, 0},      {1, 1},      {0.5, 0.25},  {0.75, 0.75},
                                            {0.25, 1},     {-0.9, 0.4}, {0.6, -0.6}, {-0.4, -0.1}, {-0.75, -0.5}};

Worst worst_of(const Instrument& instrument, const PupilFilter& filter, const std::vector<glm::dvec2>& points) {
    Worst worst;
    for (const glm::dvec2 share : points) {
        const PointWaves point(instrument, share * instrument.first_order.field_corner, 1);
        const FilterError error = largest_filter_error(filter, point, reach_of_filter(instrument));
        const auto integral = point.at_height(error.height).transfer(error.frequency);
        worst.error = std::max(worst.error, error.difference);
        worst.integral = std::max(worst.integral, std::abs(error.waves - integral));
    }
    return worst;
}

// At NA 0.28 with corners 1.13 mm apart, the filters are within 0.05 of Hopkins' integral at ten points, where the
// filter of the axis is off by 0.27. The integral's own quadrature (PointWaves::transfer()) shares no lattice with that
// of the error.
TEST(FieldError, IsSmallOverAMillimetre) {
    const Instrument instrument = assemble(test::wide_microscope());
    const PupilFilter filter = filter_for_waves(instrument);
    EXPECT_GT(filter.tiles().across(), 1);
    const Worst worst = worst_of(instrument, filter, ten_points);
    EXPECT_LT(worst.error, 0.05);
    EXPECT_LT(worst.integral, 0.006);
    const Worst of_axis = worst_of(instrument, filter_for_waves(instrument, {.tiles = 1}), {{1, 1}});
    EXPECT_GT(of_axis.error, 0.2);
}

// A small field keeps the one filter that it had.
TEST(FieldError, OfASmallFieldAsksForOneFilter) {
    const PupilFilter filter = filter_for_waves(assemble(test::microscope()));
    EXPECT_EQ(filter.tiles().across(), 1);
    EXPECT_EQ(filter.cells().side, 8u);
}

// Displaced lenses have no symmetry: each point has a wavefront of its own, on both sides of the axis.
TEST(FieldError, IsSmallWithDisplacedParts) {
    auto description = test::wide_microscope();
    description.objective_placement.change.decentre_y = 0.3;
    const Instrument instrument = assemble(description);
    const PupilFilter filter = filter_for_waves(instrument, {.cells = 10, .tiles = 5});
    const std::vector<glm::dvec2> points = {{0, 0}, {0.75, 0.75}, {0.75, -0.75}, {0, 1}, {0, -1}};
    const Worst worst = worst_of(instrument, filter, points);
    EXPECT_LT(worst.error, 0.06); // ten cells leave as much of these wavefronts
    const Worst of_axis = worst_of(instrument, filter_for_waves(instrument, {.cells = 10, .tiles = 1}), {{0, 1}});
    EXPECT_GT(of_axis.error, 0.2);
}

} // namespace
} // namespace vkfv::optics
