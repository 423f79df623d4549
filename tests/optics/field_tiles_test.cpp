// The filters of waves over the field blend from tile to tile, and each is that of its own point's wavefront.
#include "optics/waves/field_tiles.hpp"

#include "core/mathematics/units.hpp"
#include "optics/instrument/image_quality.hpp"
#include "optics/waves/filter_error.hpp"
#include "parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace vkfv::optics {
namespace {

// Bilinear weights add up to 1 and give back every point of the field, as linear interpolation does.
TEST(FieldTiles, AreBlendedBilinearly) {
    auto description = test::wide_microscope();
    description.detector_pixels = {64, 48};
    const Instrument instrument = assemble(description);
    const FieldTiles tiles(instrument, 5);
    ASSERT_EQ(tiles.count(), 25);
    const glm::dvec2 half = instrument.first_order.field_corner;
    EXPECT_NEAR(half.y / half.x, 0.75, 1e-12);
    EXPECT_NEAR(glm::length(tiles.point(0) + half), 0, 1e-12);
    EXPECT_NEAR(glm::length(tiles.point(12)), 0, 1e-12);
    EXPECT_NEAR(glm::length(tiles.point(9) - half * glm::dvec2(1, -0.5)), 0, 1e-12);
    for (const glm::dvec2 share : {glm::dvec2(0), {0.3, -0.8}, {-0.99, 0.2}, {1, 1}, {0.5, -0.5}}) {
        double sum = 0;
        glm::dvec2 point(0);
        for (const auto& [tile, weight] : tiles.shares(share * half)) {
            EXPECT_GT(weight, 0);
            sum += weight;
            point += weight * tiles.point(tile);
        }
        EXPECT_NEAR(sum, 1, 1e-12);
        EXPECT_NEAR(glm::length(point - share * half), 0, 1e-12);
    }
    // Beyond the border the shares are those on the border.
    const auto beyond = tiles.shares(3.0 * half);
    ASSERT_EQ(beyond.size(), 1u);
    EXPECT_EQ(beyond.front().tile, 24);
}

// The filters of a tile that is another one's mirror image are those of the point's own wavefront, except for points of
// the lattice on the rim, which is known to 5e-10 of its radius.
TEST(FieldTiles, OfASymmetricTrainAreMirrorImages) {
    const Instrument instrument = assemble(test::wide_microscope());
    const CellTransfer axis(instrument, 4);
    const FieldTiles tiles(instrument, 3);
    const FieldTransfer field(instrument, axis, tiles);
    const double unit = axis.cutoff() / axis.steps();
    for (const int tile : {0, 1, 2, 3, 5, 6, 7, 8}) {
        auto wavefronts = wavefronts_for_cells(instrument, tiles.point(tile));
        wavefronts.front() = wavefronts.front().at_height(wavefronts.front().sharpest_height());
        const CellTransfer alone(axis, std::move(wavefronts));
        for (const glm::dvec2 place : {glm::dvec2(5, 3), {-7, 11}, {4, -9}, {-8, 0}, {0, 12}}) {
            const auto mirrored = field.at(tile, unit * place.x, unit * place.y);
            const auto own = alone.at(unit * place.x, unit * place.y);
            double apart = 0;
            for (std::size_t cell = 0; cell < own.size(); ++cell) {
                EXPECT_NEAR(std::abs(mirrored[cell] - own[cell]), 0, 0.01) << tile << ' ' << cell;
                apart += std::abs(field.at(4, unit * place.x, unit * place.y)[cell] - own[cell]);
            }
            EXPECT_GT(apart, 0.1); // the twin: those of the axis
        }
    }
}

// The table of a device has the values that single frequencies have.
TEST(FieldTiles, SingleFrequenciesAreThoseOfTheTable) {
    auto description = test::wide_microscope();
    for (const double decentre : {0.0, 0.5}) {
        description.tube_lens_placement.change.decentre_y = decentre;
        const Instrument instrument = assemble(description);
        const PupilFilter filter(instrument, {.cells = 2, .tiles = 3});
        const double unit = filter.cutoff() / filter.steps();
        const FieldTransfer field(instrument, CellTransfer(instrument, 2), FieldTiles(instrument, 3));
        for (const int tile : {0, 1, 5, 7}) {
            for (const glm::dvec2 place : {glm::dvec2(5, 3), {-5, 3}, {4, -9}, {2.3, 6.8}}) {
                const auto single = field.at(tile, unit * place.x, unit * place.y);
                for (int cell = 0; cell < filter.cell_count(); ++cell) {
                    EXPECT_NEAR(std::abs(single[static_cast<std::size_t>(cell)] -
                                         filter.transfer(tile, cell, unit * place.x, unit * place.y)),
                                0, 2e-7);
                }
            }
        }
    }
}

} // namespace
} // namespace vkfv::optics
