// The transfer functions of the pupil's cells, at single frequencies: what a PupilFilter is a table of. An instrument's
// figures need a hundredth of that table.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "optics/waves/wavefront.hpp"
#include "physics/physics.hpp"

#include <cmath>
#include <complex>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace vkfv::optics {

// A place in a table of transfer functions, whose nodes lie at -steps ... steps and whose rows at 0 ... steps: 0 beyond
// them, and for rows below 0 the conjugate of the opposite.
struct TablePlace {
    std::ptrdiff_t node = 0; // at its lower left
    double right = 0;        // of that node, 0 to 1
    double above = 0;
    bool inside = false;
    bool opposite = false;
};

inline TablePlace table_place(int steps, double x, double y) {
    if (y < 0 || (y == 0 && x < 0)) {
        TablePlace place = table_place(steps, -x, -y);
        place.opposite = !place.opposite;
        return place;
    }
    if (std::abs(x) >= steps || y >= steps) {
        return {};
    }
    const double left = std::floor(x);
    const double low = std::floor(y);
    return {.node = static_cast<std::ptrdiff_t>(low) * (2 * steps + 1) + static_cast<int>(left) + steps,
            .right = x - left,
            .above = y - low,
            .inside = true};
}

// The value there, bilinear between the nodes of one cell's table.
template <class Value>
std::complex<double> interpolated(const Value* values, int steps, const TablePlace& place) {
    using Complex = std::complex<double>;
    if (!place.inside) {
        return 0;
    }
    const auto row = [&](const Value* first) {
        return Complex(first[0]) * (1 - place.right) + Complex(first[1]) * place.right;
    };
    const Value* corner = values + place.node;
    const Complex value = row(corner) * (1 - place.above) + row(corner + 2 * steps + 1) * place.above;
    return place.opposite ? std::conj(value) : value;
}

// The wavefronts that the filters of an instrument are made of, its spectrum by a few wavelengths: of a point of the
// field (mm in the object), the axis if none is given.
std::vector<Wavefront> wavefronts_for_cells(const Instrument& instrument, glm::dvec2 field = glm::dvec2(0));

// Nodes of a table of so many cells across the pupil, from 0 to the cutoff.
int table_steps(int cells);

class CellTransfer {
  public:
    // Of so many cells across the pupil of the axis, for pixels that are not parted. Throws InputError where no light
    // comes through.
    CellTransfer(const Instrument& instrument, int cells);
    // Of these wavefronts, wavefronts_for_cells().
    CellTransfer(const Instrument& instrument, std::vector<Wavefront> wavefronts, int cells);
    // Has the same cells, frequencies and steps as on the axis, and the wavefronts of another point of the field, whose
    // light passes: its pupil lies about its own chief ray.
    CellTransfer(const CellTransfer& axis, std::vector<Wavefront> wavefronts);
    ~CellTransfer();
    CellTransfer(CellTransfer&&) noexcept;
    CellTransfer& operator=(CellTransfer&&) noexcept;

    const physics::f64::PupilCells& cells() const { return cells_; }
    std::size_t cell_count() const { return shares_.size(); }
    const std::vector<double>& shares() const { return shares_; } // of the light, of each cell
    double cutoff() const { return cutoff_; }                     // cycles per mm of the object plane
    int steps() const { return steps_; }                          // nodes from 0 to the cutoff

    // PupilFilter::table(), by all cores.
    std::vector<std::complex<float>> table() const;
    // The values that this table has at a frequency (cycles per mm), of each cell; but for rounding in the rare case
    // that a value lies between two floats as nearly as double can tell. Nodes are kept; several threads may ask.
    std::vector<std::complex<double>> at(double fx, double fy) const;

  private:
    struct Lattice;
    using CellValues = std::vector<std::complex<double>>;

    const CellValues& node_of_wavelength(std::size_t wavelength, int dx, int dy) const;
    CellValues table_node(int dx, int dy) const;
    void add_lattice(const Wavefront& wavefront, glm::dvec2 middle, glm::dvec2 slope);
    void find_nearest_lit();

    struct Nodes {
        std::mutex mutex;
        std::map<std::pair<int, int>, CellValues> values; // by (dx, dy), of one wavelength; they never move
    };

    physics::f64::PupilCells cells_{};
    int steps_ = 0;
    double cutoff_ = 0;
    bool round_ = false; // the pupil is its own mirror image about both axes and their bisectors
    std::vector<Wavefront> wavefronts_;
    std::vector<std::unique_ptr<Lattice>> lattices_; // of each
    std::vector<double> shares_;
    std::vector<std::size_t> nearest_lit_; // of each cell: itself, or the cell whose values it has
    std::vector<std::unique_ptr<Nodes>> nodes_;
};

} // namespace vkfv::optics
