// The filter that turns an image traced by rays into the wave-optical one, at every height of focus: light is sorted by
// where it crosses the pupil (physics/pupil_cells.glsl), and each cell's image is filtered by its own transfer
// function. The rays carry defocus, the surface's slope, shadows and vignetting; the filter adds what they lack, the
// overlap of two displaced pupils.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "optics/waves/cell_transfer.hpp"
#include "optics/waves/field_tiles.hpp"
#include "physics/physics.hpp"

#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

namespace vkfv::optics {

// The contrast error of filtered images relative to waves: see largest_filter_error().
struct FilterError {
    double difference = 0;                                // |filtered - waves|
    glm::dvec2 frequency = glm::dvec2(0);                 // frequency of the largest error, cycles per mm of the object
    double height = 0;                                    // height of the object plane above z = 0, mm
    std::complex<double> waves = std::complex<double>(0); // Hopkins' transfer function of this point of the field
    std::complex<double> filtered = std::complex<double>(0); // transfer of this point's rays with the filter
};

// The transfer functions of one tile's cells in a filter's table; the filter must outlive this.
class TileTransfers {
  public:
    // table: cell by cell, each with `plane` nodes; cutoff in cycles per mm of the object plane.
    TileTransfers(std::span<const std::complex<float>> table, std::size_t plane, int steps, double cutoff)
        : table_(table), plane_(plane), steps_(steps), scale_(steps / cutoff) {}

    // The table's place of a frequency in cycles per mm of the object plane; it is the same in every cell and tile.
    TablePlace place(double fx, double fy) const { return table_place(steps_, fx * scale_, fy * scale_); }
    std::complex<double> at(int cell, const TablePlace& place) const {
        return interpolated(table_.data() + static_cast<std::size_t>(cell) * plane_, steps_, place);
    }

  private:
    std::span<const std::complex<float>> table_;
    std::size_t plane_;
    int steps_;
    double scale_;
};

struct WaveOptions {
    int cells = 0;                 // across the pupil, even; 0: chosen by the axis' aberrations
    int parts = 0;                 // subdivisions of a pixel's side in which light is sorted; 0: as fine as waves need
    int tiles = 0;                 // filters across the field, an odd number; 0: chosen by the field's aberrations
    std::uint64_t most_memory = 0; // bytes of a device that the filter may use; 0: all of the device's
    int sharers = 1;               // images of different light that share this memory at a time
};

// The number of parts of a pixel's side for which the part's pitch is at most lambda / (4 NA) at the shortest
// wavelength: all frequencies that the pupil passes are then below half a cycle a part.
int parts_for_waves(const Instrument& instrument);
// The parts of the options, or parts_for_waves() if these are 0.
int parts_of(const WaveOptions& options, const Instrument& instrument);
// The options with zeros replaced: parts by parts_for_waves(), cells and tiles by the choice of filter_for_waves()
// (optics/waves/filter_error.hpp), which makes and compares filters.
WaveOptions resolved(const WaveOptions& options, const Instrument& instrument);

// The filter of an instrument's axis. The image has the spectrum  sum over the cells c of  w_c(f) I_c(f)  with
//   w_c(f) = mean over p in c of  1{p + lambda f / 2 and p - lambda f / 2 in the pupil}
//                                 exp(-i k [W(p + lambda f / 2) - W(p - lambda f / 2)])
//            over the mean of exp(-2 pi i f . t(p)), its modulus at most 1,
// where p are direction cosines times the index in the object space, W the wavefront and t its rays' displacement in
// best focus (optics/waves/wavefront.hpp), by the transform exp(-2 pi i f . x). The product with the rays' own transfer
// is Hopkins' transfer function (Proc. R. Soc. A 231, 91, 1955), in best focus exactly where |w_c| <= 1; the limit
// keeps noise from growing. w_c(0) = 1. Several wavelengths are averaged by their shares of the light.
//
// Where the aberrations change over the field, a lattice of its points has transfer functions of their own, and their
// images are blended: optics/waves/field_tiles.hpp.
class PupilFilter {
  public:
    // Makes the filter; throws InputError if no light passes.
    PupilFilter(const Instrument& instrument, const WaveOptions& options);
    // A filter of so many cells across the pupil, for pixels without parts; its noise() is not available.
    static PupilFilter unparted(const Instrument& instrument, int cells);
    static PupilFilter unparted(const Instrument& instrument, std::vector<Wavefront> wavefronts, int cells);

    // Divides the pixels of the filter's instrument into parts; must precede noise().
    void set_parts(const Instrument& instrument, int parts);
    // A filter of the same cells with so many tiles across the field of its instrument.
    PupilFilter tiled(const Instrument& instrument, int tiles) const;
    const FieldTiles& tiles() const { return tiles_; }

    const physics::f64::PupilCells& cells() const { return cells_; }
    int cell_count() const { return static_cast<int>(physics::f64::pupil_cell_count(cells_)); }
    // The filter's errors on the axis, at the edge and in the corner of the field, as far as they were needed to choose
    // cells and tiles.
    struct KnownErrors {
        std::optional<FilterError> axis;
        std::optional<FilterError> edge;
        std::optional<FilterError> corner;
    };
    const KnownErrors& known_errors() const { return known_errors_; }
    void set_known_errors(const KnownErrors& errors) { known_errors_ = errors; }
    // The share of a cell in the light from the axis that fills the pupil as a Lambertian surface's does. Light in a
    // cell of share 0 comes from the field's edge; it is filtered as in the nearest other cell.
    double share(int cell) const { return made_->axis->shares()[static_cast<std::size_t>(cell)]; }
    // The cells that contain the mirror images, left to right and upside down, of a cell's light.
    int mirrored(int cell) const;
    int mirrored_upright(int cell) const;

    // Transfer functions from the table, which is made at the first call: all of a tile, or w at a frequency (cycles
    // per mm of the object plane) for a tile or for the middle tile.
    TileTransfers tile_transfers(int tile) const;
    std::complex<double> transfer(int tile, int cell, double fx, double fy) const;
    std::complex<double> transfer(int cell, double fx, double fy) const {
        return transfer(middle_tile(), cell, fx, fy);
    }
    // The transfer functions of all cells at a frequency, without the table: on the axis, and blended between the tiles
    // about a point of the detector (mm, in the frame of physics::Detection).
    std::vector<std::complex<double>> transfers(double fx, double fy) const { return made_->axis->at(fx, fy); }
    std::vector<std::complex<double>> transfers(glm::dvec2 detector_point, double fx, double fy) const;
    double cutoff() const { return made_->axis->cutoff(); } // 2 NA / lambda of the shortest wavelength, cycles per mm
    double part_pitch() const { return part_pitch_; }       // mm in the object plane

    // The factor by which the filter changes the standard deviation of a pixel's noise, for uniform light.
    double noise() const;

    // The largest contrast error by aliasing: beyond half a cycle a part a wave is filtered as its alias. For waves
    // that the pupil passes and a level Lambertian specimen the error is at most the largest
    //   |sinc(fx pitch) sinc(fy pitch)| sum over c of share(c) |w_c(folded f) - w_c(f)|,
    // as no cell's rays have a contrast above 1 (pitch: the pixels'). 0 if the pupil passes no such wave.
    double folded_contrast() const;

    // The table in the layout that a device reads: w at fx = column / steps cutoff, from -steps to steps, and
    // fy = row / steps cutoff, from 0; tile by tile, cell by cell, row by row. Values between nodes are bilinear; those
    // for fy < 0 are the conjugates of the values at -f. The table is made at the first call.
    const std::vector<std::complex<float>>& table() const;
    int steps() const { return made_->axis->steps(); }

  private:
    struct Made { // shared by copies
        std::shared_ptr<const CellTransfer> axis;
        std::unique_ptr<const FieldTransfer> field{}; // null with a single tile
        std::once_flag table_once{};
        std::vector<std::complex<float>> table{};
        std::once_flag noise_once{};
        double noise = 1;
    };

    PupilFilter(CellTransfer transfer, const Instrument& instrument);
    double noise_of_pixels() const;
    int middle_tile() const { return tiles_.count() / 2; }

    physics::f64::PupilCells cells_{};
    double part_pitch_ = 0;
    bool parted_ = false;
    double magnification_ = -1;
    KnownErrors known_errors_;
    FieldTiles tiles_;
    std::shared_ptr<Made> made_;
};

} // namespace vkfv::optics
