// The image that waves make of light sorted by pupil cells, on the host in double.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/mathematics/pixel_grid.hpp"
#include "optics/waves/pupil_filter.hpp"
#include "trace/interface/pixel_estimate.hpp"
#include "trace/interface/tracer.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace vkfv::trace {

// Beyond its border the image continues as its mirror image, the pupil mirrored with it, so that no light is lost: of
// an instrument that is symmetric about its axis the sum over the pixels stays the same, of others but for what the
// asymmetry of the point spread carries over the border.
class WaveImage {
  public:
    // pixels: the detector's. The filter must outlive it.
    WaveImage(const optics::PupilFilter& filter, ImageSize pixels);

    // How many numbers the sorted light has: cell after cell, row after row of parts of pixels.
    std::size_t numbers() const;
    std::size_t numbers_a_cell() const { return size_.count(); }
    int columns() const { return size_.columns; } // of them, in a row
    // Light of the pixels in the units of the sorted light.
    Grid<double> apply(std::span<const std::uint64_t> light) const;
    // The same from cells that the calling thread asks for one after the other and does not keep: four times as many
    // cells at a time as there are cores, and of each the rows of parts of pixels that a window of the field's tiles
    // takes.
    using RowsOfCell = std::function<std::vector<std::uint64_t>(int cell, int first_row, int rows)>;
    Grid<double> apply(const RowsOfCell& rows_of_cell) const;

  private:
    struct Spectrum;
    class Window;
    std::array<int, 4> mirror_images(int cell) const;

    const optics::PupilFilter& filter_;
    ImageSize pixels_;
    ImageSize size_; // in parts of pixels
};

// Light that the host sorts; many may add to it at a time. Without a filter nothing is kept.
class CellLight {
  public:
    CellLight(const std::optional<optics::PupilFilter>& filter, ImageSize pixels);

    void add(const physics::f64::CellPlace& place, std::uint64_t light);
    Grid<double> image() const { return image_.value().apply(numbers_); }

  private:
    std::optional<WaveImage> image_;
    ImageSize size_; // in parts of pixels
    std::vector<std::uint64_t> numbers_;
};

// The filter that the options ask for, of an instrument that is not turned round; none: images as rays make them.
std::optional<optics::PupilFilter> filter_for_waves(const optics::Instrument& instrument, const TraceOptions& options);

// The same pixels with their light as waves make it, from that of WaveImage::apply(), in power_per_number W a unit.
PixelLight with_waves(PixelLight pixels, const Grid<double>& light, double power_per_number,
                      const optics::PupilFilter& filter);

} // namespace vkfv::trace
