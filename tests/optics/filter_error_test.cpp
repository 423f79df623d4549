// The filter of the axis differs from waves anywhere in the field by no more than it says.
#include "optics/waves/filter_error.hpp"

#include "core/mathematics/units.hpp"
#include "parts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::optics {
namespace {

PointWaves waves_of(const Instrument& instrument, glm::dvec2 field) {
    return PointWaves(instrument, field, 3);
}

// On the axis a grid of 8 x 8 cells leaves an error: 0.0561 with the 10x, at 3/8 of the cutoff and two depths of field
// under z = 0, by tests/references/filter_error_reference.py, which sums over another lattice of the pupil.
TEST(FilterError, OfTheTenfoldObjective) {
    const Instrument instrument = assemble(test::microscope());
    const PupilFilter filter(instrument, {});
    EXPECT_EQ(filter.cells().side, 8u);
    const double reach = 2 * instrument.first_order.depth_of_field;
    const double side = instrument.first_order.field_edge;
    double before = 0;
    for (const glm::dvec2 field : {glm::dvec2(0), glm::dvec2(side, 0), glm::dvec2(8 * side)}) {
        const PointWaves point = waves_of(instrument, field);
        const FilterError error = largest_filter_error(filter, point, reach);
        EXPECT_LE(std::abs(error.height), reach);
        EXPECT_NEAR(std::abs(error.filtered - error.waves), error.difference, 1e-12);
        const auto integral = point.at_height(error.height).transfer(error.frequency);
        EXPECT_NEAR(std::abs(error.waves - integral), 0, 0.006) << field.x;
        if (field == glm::dvec2(0)) {
            EXPECT_NEAR(error.difference, 0.0561, 0.002);
            EXPECT_NEAR(glm::length(error.frequency) / filter.cutoff(), 0.375, 0.02);
            EXPECT_NEAR(error.height, -reach, 1e-12);
        } else {
            // Farther out the wavefront differs more and more from that of the axis.
            EXPECT_GT(error.difference, 0.95 * before) << field.x;
        }
        before = error.difference;
    }
    EXPECT_GT(before, 0.1);
}

// The spherical aberration of the 5x needs more cells than the 10x has; a number that is asked for is not changed.
TEST(FilterError, DecidesHowManyCellsThereAre) {
    const Instrument instrument = assemble(test::microscope("5x_0.15"));
    const auto error = [&](const PupilFilter& filter) {
        return largest_filter_error(filter, instrument, glm::dvec2(0)).difference;
    };
    const PupilFilter filter(instrument, {});
    EXPECT_EQ(filter.cells().side, 14u);
    EXPECT_LE(error(filter), most_error_of_cells);
    const PupilFilter fewer(instrument, {.cells = 12});
    EXPECT_EQ(fewer.cells().side, 12u);
    EXPECT_GT(error(fewer), most_error_of_cells);
}

// Cells are those of the pupil, wherever the detector sees it.
TEST(FilterError, OfATiltedDetectorIsThatOfAnUprightOne) {
    auto description = test::microscope();
    const auto on_axis = [&] {
        const Instrument instrument = assemble(description);
        return largest_filter_error(PupilFilter(instrument, {.cells = 8}), instrument, glm::dvec2(0)).difference;
    };
    const double upright = on_axis();
    description.detector_placement.change.tilt_y = 5 * pi / 180;
    EXPECT_NEAR(on_axis(), upright, 0.01); // before the chief ray's slope was taken off: 0.7
}

// Without aberration the whole field has the error of the axis, except for that of the cells.
TEST(FilterError, OfIdealLensesIsThatOfTheAxis) {
    const Instrument instrument = assemble(test::ideal_microscope(0.28));
    const PupilFilter filter(instrument, {.cells = 16});
    const double reach = instrument.first_order.depth_of_field;
    const double side = instrument.first_order.field_edge;
    const double on_axis = largest_filter_error(filter, waves_of(instrument, glm::dvec2(0)), reach).difference;
    const double in_corner = largest_filter_error(filter, waves_of(instrument, glm::dvec2(side)), reach).difference;
    EXPECT_LT(on_axis, 0.015);
    EXPECT_NEAR(in_corner, on_axis, 0.004);
    // With few cells the error is larger.
    EXPECT_GT(largest_filter_error(PupilFilter(instrument, {.cells = 2}), waves_of(instrument, glm::dvec2(0)), reach)
                  .difference,
              0.15);
}

// With a pupil of one wavelength, waves at s of the cutoff come out as those of 2 s_0 - s, where a part holds half a
// cycle at s_0.
TEST(FilterError, OfPartsThatAreTooCoarse) {
    auto description = test::ideal_microscope(0.28);
    const Instrument instrument = assemble(description);
    const int enough = parts_for_waves(instrument);
    ASSERT_GE(enough, 2);
    EXPECT_EQ(PupilFilter(instrument, {.cells = 8, .parts = enough}).folded_contrast(), 0);
    const PupilFilter coarse(instrument, {.cells = 8, .parts = 1});
    const double half_cycle = 0.5 / instrument.first_order.pixel_pitch / coarse.cutoff();
    const auto in_focus = [](double s) { return 2 / pi * (std::acos(s) - s * std::sqrt(1 - s * s)); };
    double expected = 0;
    for (double s = half_cycle; s < 1; s += 0.001) {
        const double folded = std::abs(s - 2 * half_cycle * std::round(0.5 * s / half_cycle));
        const double pixel = 0.5 * pi * s / half_cycle;
        expected = std::max(expected, std::abs((in_focus(folded) - in_focus(s)) * std::sin(pixel) / pixel));
    }
    EXPECT_NEAR(coarse.folded_contrast(), expected, 0.02);
}

// Few frequencies are computed one by one, an eighth of them for a round pupil: the table has the same values.
TEST(FilterError, SingleFrequenciesAreThoseOfTheTable) {
    auto description = test::microscope();
    for (const double decentre : {0.0, 1.0}) {
        description.tube_lens_placement.change.decentre_y = decentre;
        const PupilFilter filter(assemble(description), {.cells = 4});
        const double unit = filter.cutoff() / filter.steps();
        for (const glm::dvec2 place : {glm::dvec2(5, 3), glm::dvec2(-5, 3), glm::dvec2(3, 5), glm::dvec2(-7, 11),
                                       glm::dvec2(4, -9), glm::dvec2(-8, 0), glm::dvec2(2.3, 6.8), glm::dvec2(0, 60)}) {
            const auto transfers = filter.transfers(unit * place.x, unit * place.y);
            double mirrored = 0;
            for (int cell = 0; cell < filter.cell_count(); ++cell) {
                const auto expected = filter.transfer(cell, unit * place.x, unit * place.y);
                EXPECT_NEAR(std::abs(transfers[static_cast<std::size_t>(cell)] - expected), 0, 2e-7) << place.x;
                const auto other = filter.mirrored(cell);
                mirrored = std::max(mirrored, std::abs(transfers[static_cast<std::size_t>(other)] - expected));
            }
            // Cells are told apart: those of the mirror image would be found.
            EXPECT_TRUE(mirrored > 1e-3 || place.x == 0) << place.x;
        }
    }
}

} // namespace
} // namespace vkfv::optics
