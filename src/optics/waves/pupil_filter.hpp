// What waves make of an image that was traced by rays, at every height of focus: light sorted by where it crosses the
// pupil (physics/pupil_cells.glsl), each cell's image filtered by a transfer function of its own. The rays carry
// defocus, the surface's slope, shadows and vignetting; the filter adds what they lack, the overlap of two displaced
// pupils.
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

// How far the contrast of images as a filter makes them is from that of waves: largest_filter_error().
struct FilterError {
    double difference = 0;                                   // |filtered - waves|
    glm::dvec2 frequency = glm::dvec2(0);                    // where it is largest, cycles per mm of the object
    double height = 0;                                       // of the object plane above z = 0, mm
    std::complex<double> waves = std::complex<double>(0);    // Hopkins' transfer function of this point of the field
    std::complex<double> filtered = std::complex<double>(0); // what the axis' filter makes of this point's rays
};

// The transfer functions of one tile's cells as a filter's table has them, valid as long as the filter is.
class TileTransfers {
  public:
    // table: cell after cell, each of a plane of nodes; cutoff in cycles per mm of the object plane.
    TileTransfers(std::span<const std::complex<float>> table, std::size_t plane, int steps, double cutoff)
        : table_(table), plane_(plane), steps_(steps), scale_(steps / cutoff) {}

    // A frequency in cycles per mm of the object plane; its place is the same in every cell and tile.
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
    int cells = 0;                 // across the pupil, even; 0: as many as the axis' aberrations ask for
    int parts = 0;                 // of a pixel's side in which light is sorted; 0: as fine as waves ask for
    int tiles = 0;                 // filters across the field, an odd number; 0: as many as its aberrations ask for
    std::uint64_t most_memory = 0; // bytes that this may take of a device; 0: what the device has
    int sharers = 1;               // of that memory: images that are made of different light at a time
};

// Parts of a pixel's side whose pitch is at most lambda / (4 NA) for the shortest wavelength: the frequencies that the
// pupil passes are then all below a half cycle a part.
int parts_for_waves(const Instrument& instrument);
// Those asked for, else these.
int parts_of(const WaveOptions& options, const Instrument& instrument);
// The options with the cells, tiles and parts asked for, else with these parts, and the cells and tiles of
// filter_for_waves() (optics/waves/filter_error.hpp), for which filters are made and compared.
WaveOptions resolved(const WaveOptions& options, const Instrument& instrument);

// Of an instrument's axis. The image has the spectrum  sum over the cells c of  w_c(f) I_c(f)  with
//   w_c(f) = mean over p in c of  1{p + lambda f / 2 and p - lambda f / 2 in the pupil}
//                                 exp(-i k [W(p + lambda f / 2) - W(p - lambda f / 2)])
//            over the mean of exp(-2 pi i f . t(p)), its modulus at most 1,
// where p are direction cosines times the index in the object space, W the wavefront and t its rays' displacement in
// best focus (optics/waves/wavefront.hpp), by the transform exp(-2 pi i f . x). It is Hopkins' transfer function (Proc.
// R. Soc. A 231, 91, 1955) with what rays have of it left to them; in best focus exactly where |w_c| <= 1, which keeps
// noise from growing. w_c(0) = 1. Of several wavelengths the mean by their shares of the light.
//
// Where the aberrations change over the field, a lattice of its points has transfer functions of their own, and their
// images are blended: optics/waves/field_tiles.hpp.
class PupilFilter {
  public:
    // Throws InputError where no light comes through.
    PupilFilter(const Instrument& instrument, const WaveOptions& options);
    // Of so many cells across the pupil, for pixels that are not parted; without its noise().
    static PupilFilter unparted(const Instrument& instrument, int cells);
    static PupilFilter unparted(const Instrument& instrument, std::vector<Wavefront> wavefronts, int cells);

    // Of its instrument's pixels, before noise() is asked for.
    void set_parts(const Instrument& instrument, int parts);
    // A filter of the same cells, with so many tiles across the field of its instrument.
    PupilFilter tiled(const Instrument& instrument, int tiles) const;
    const FieldTiles& tiles() const { return tiles_; }

    const physics::f64::PupilCells& cells() const { return cells_; }
    int cell_count() const { return static_cast<int>(physics::f64::pupil_cell_count(cells_)); }
    // Its errors on the axis, at the edge and in the corner of the field, as far as they decided how many cells and
    // tiles there are.
    struct KnownErrors {
        std::optional<FilterError> axis;
        std::optional<FilterError> edge;
        std::optional<FilterError> corner;
    };
    const KnownErrors& known_errors() const { return known_errors_; }
    void set_known_errors(const KnownErrors& errors) { known_errors_ = errors; }
    // Of light from the axis that fills the pupil as a Lambertian surface's does. What arrives in a cell of share 0
    // comes from the field's edge; it is filtered as that of the nearest other cell.
    double share(int cell) const { return made_->axis->shares()[static_cast<std::size_t>(cell)]; }
    // The cells that the mirror images of a cell's light, left to right and upside down, belong to.
    int mirrored(int cell) const;
    int mirrored_upright(int cell) const;

    // By the table, which is made when it is first asked for: all of a tile; and w of a frequency (cycles per mm of the
    // object plane), of a tile and of that in the middle.
    TileTransfers tile_transfers(int tile) const;
    std::complex<double> transfer(int tile, int cell, double fx, double fy) const;
    std::complex<double> transfer(int cell, double fx, double fy) const {
        return transfer(middle_tile(), cell, fx, fy);
    }
    // The transfer functions of all cells at a few frequencies, without the table: on the axis, and as the tiles about
    // a point of the detector (mm, in the frame of physics::Detection) are blended there.
    std::vector<std::complex<double>> transfers(double fx, double fy) const { return made_->axis->at(fx, fy); }
    std::vector<std::complex<double>> transfers(glm::dvec2 detector_point, double fx, double fy) const;
    double cutoff() const { return made_->axis->cutoff(); } // 2 NA / lambda of the shortest, cycles per mm
    double part_pitch() const { return part_pitch_; }       // mm in the object plane

    // Standard deviation of a pixel's noise after the filter over that before it, for light that is alike everywhere.
    double noise() const;

    // Beyond half a cycle a part a wave is filtered as the one that it folds back to. By how much the contrast of a
    // level Lambertian specimen's image is off then, at most, for waves that the pupil passes: the largest
    //   |sinc(fx pitch) sinc(fy pitch)| sum over c of share(c) |w_c(folded f) - w_c(f)|,
    // where rays have in no cell more than the contrast 1 (pitch: the pixels'). 0 where no such wave passes.
    double folded_contrast() const;

    // As a device reads it: w at fx = column / steps cutoff, from -steps to steps, and fy = row / steps cutoff, from 0,
    // bilinear between; tile after tile, cell after cell, row after row. For fy < 0: the conjugate of -f.
    // It is made when it is first asked for.
    const std::vector<std::complex<float>>& table() const;
    int steps() const { return made_->axis->steps(); }

  private:
    struct Made { // shared by copies
        std::shared_ptr<const CellTransfer> axis;
        std::unique_ptr<const FieldTransfer> field{}; // where there are several tiles
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
