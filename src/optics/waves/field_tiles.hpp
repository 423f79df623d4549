// Wave filters over the field: tiles with a filter each, blended in between.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "optics/waves/cell_transfer.hpp"

#include <complex>
#include <cstddef>
#include <memory>
#include <vector>

namespace vkfv::optics {

// A square lattice of field points with a filter each, an odd number across, the outer ones on the field's border.
// Between the points the filters' images are blended bilinearly, so that weights are positive and sum to 1. A single
// point lies on the axis.
class FieldTiles {
  public:
    FieldTiles() = default;
    // across: the number of points along a side, odd.
    FieldTiles(const Instrument& instrument, int across);

    int across() const { return across_; }
    int count() const { return across_ * across_; }
    // The field point of a tile (mm in the object, inversion removed); tiles are numbered row by row, x first.
    glm::dvec2 point(int tile) const;

    struct Share {
        int tile;
        double weight;
    };
    // The tiles that are blended at a point of the field (mm in the object), with their positive weights. Beyond the
    // field's border the border's tiles serve.
    std::vector<Share> shares(glm::dvec2 field) const;

  private:
    int across_ = 1;
    glm::dvec2 half_field_{0}; // mm in the object
};

// The transfer functions of the pupil's cells at every tile of FieldTiles. Each comes from the wavefronts of its own
// point, in the plane where that point's light is sharpest: there the rays' own displacement is smallest, and they
// carry the defocus of other heights. In a symmetric train, points that are mirror images of others are not computed;
// with displaced parts no symmetry is assumed.
class FieldTransfer {
  public:
    // axis: gives the cells, and the transfer functions of points without light.
    FieldTransfer(const Instrument& instrument, const CellTransfer& axis, const FieldTiles& tiles);

    // The transfer functions of a tile's cells at a frequency (cycles per mm), as CellTransfer::at().
    std::vector<std::complex<double>> at(int tile, double fx, double fy) const;
    // CellTransfer::table() of all tiles, concatenated.
    std::vector<std::complex<float>> table() const;

  private:
    // The reflections that map a computed point's pupil to this point's.
    struct Image {
        std::size_t of = 0;    // index into computed_
        bool swapped = false;  // x and y exchanged, applied first
        bool mirrored = false; // left and right exchanged
        bool upright = false;  // top and bottom exchanged
    };
    int cell_there(const Image& image, int cell) const;

    int side_ = 0; // cells across the pupil
    int steps_ = 0;
    std::vector<std::unique_ptr<const CellTransfer>> computed_;
    std::vector<Image> images_; // one for each tile
};

} // namespace vkfv::optics
