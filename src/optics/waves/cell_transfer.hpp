// The transfer functions of the pupil's cells at single frequencies. PupilFilter is a table of them; an instrument's
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

// A place in a table of transfer functions, with columns -steps ... steps and rows 0 ... steps. Beyond the table the
// functions are 0; in rows below 0 they are the conjugate of the value at the opposite frequency.
struct TablePlace {
    std::ptrdiff_t node = 0; // index of the node at the place's lower left
    double right = 0;        // distance from that node in units of the spacing, 0 to 1
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

// The value of one cell's table at a place, bilinear between nodes.
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

// The wavefronts from which an instrument's filters are made, at a few wavelengths of its spectrum, for a point of the
// field (mm in the object).
std::vector<Wavefront> wavefronts_for_cells(const Instrument& instrument, glm::dvec2 field = glm::dvec2(0));

// The number of steps from 0 to the cutoff in a table for so many cells across the pupil.
int table_steps(int cells);

class CellTransfer {
  public:
    // Divides the pupil of the axis into so many cells across, for pixels without parts. Throws InputError if no light
    // passes.
    CellTransfer(const Instrument& instrument, int cells);
    // Divides the pupil of the axis, with wavefronts that wavefronts_for_cells() has traced already.
    CellTransfer(const Instrument& instrument, std::vector<Wavefront> wavefronts, int cells);
    // The transfer functions of another point of the field, from its wavefronts, which must pass light. Cells,
    // frequencies and steps are those on the axis; the pupil is centred on the point's own chief ray.
    CellTransfer(const CellTransfer& axis, std::vector<Wavefront> wavefronts);
    ~CellTransfer();
    CellTransfer(CellTransfer&&) noexcept;
    CellTransfer& operator=(CellTransfer&&) noexcept;

    const physics::f64::PupilCells& cells() const { return cells_; }
    std::size_t cell_count() const { return shares_.size(); }
    const std::vector<double>& shares() const { return shares_; } // share of the light in each cell
    double cutoff() const { return cutoff_; }                     // cycles per mm of the object plane
    int steps() const { return steps_; }                          // steps from 0 to the cutoff

    // Computes PupilFilter::table() on all cores.
    std::vector<std::complex<float>> table() const;
    // The table's values at a frequency (cycles per mm), for each cell. They may differ from the table by rounding in
    // the rare case that a value lies halfway between two floats within double's precision. Computed nodes are kept;
    // several threads may call.
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
        // Values by (dx, dy), for one wavelength; references to them stay valid.
        std::map<std::pair<int, int>, CellValues> values;
    };

    physics::f64::PupilCells cells_{};
    int steps_ = 0;
    double cutoff_ = 0;
    bool round_ = false; // the pupil is symmetric about both axes and their bisectors
    std::vector<Wavefront> wavefronts_;
    std::vector<std::unique_ptr<Lattice>> lattices_; // one for each wavefront
    std::vector<double> shares_;
    std::vector<std::size_t> nearest_lit_; // for each cell: itself, or the cell whose values it takes
    std::vector<std::unique_ptr<Nodes>> nodes_;
};

} // namespace vkfv::optics
