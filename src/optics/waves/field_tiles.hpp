// The filters of waves over the field: each of its own point, blended in between.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "optics/waves/cell_transfer.hpp"

#include <complex>
#include <cstddef>
#include <memory>
#include <vector>

namespace vkfv::optics {

// A square lattice of points of the field with a filter each, odd many across it, the outer ones on its border. Between
// them the filters' images are blended bilinearly, so that weights are positive and add up to 1. One point: the axis.
class FieldTiles {
  public:
    FieldTiles() = default;
    // across: points along a side, odd.
    FieldTiles(const Instrument& instrument, int across);

    int across() const { return across_; }
    int count() const { return across_ * across_; }
    // Row after row, x first: mm in the object, inversion removed.
    glm::dvec2 point(int tile) const;

    struct Share {
        int tile;
        double weight;
    };
    // The tiles that are blended at a point of the field (mm in the object), with their weights above 0. Beyond the
    // field's border they are those of the border.
    std::vector<Share> shares(glm::dvec2 field) const;

  private:
    int across_ = 1;
    glm::dvec2 half_field_{0}; // mm in the object
};

// The transfer functions of the cells at every point of such a lattice, each of the wavefronts of its own point (for a
// train with displaced parts without any symmetry taken for granted), in the plane where the light of that point is
// sharpest: there the rays' own displacement is smallest, and they carry what other heights add. Of a symmetric train
// the points that are mirror images of another are not computed.
class FieldTransfer {
  public:
    // axis: the cells, and what counts for a point that no light comes from.
    FieldTransfer(const Instrument& instrument, const CellTransfer& axis, const FieldTiles& tiles);

    // CellTransfer::at() of the tile's point.
    std::vector<std::complex<double>> at(int tile, double fx, double fy) const;
    // CellTransfer::table() of all tiles, one after the other.
    std::vector<std::complex<float>> table() const;

  private:
    // The mirroring that makes a point's pupil of one that is computed.
    struct Image {
        std::size_t of = 0;    // of computed_
        bool swapped = false;  // x and y, first
        bool mirrored = false; // left to right
        bool upright = false;  // upside down
    };
    int cell_there(const Image& image, int cell) const;

    int side_ = 0; // cells across the pupil
    int steps_ = 0;
    std::vector<std::unique_ptr<const CellTransfer>> computed_;
    std::vector<Image> images_; // of each tile
};

} // namespace vkfv::optics
