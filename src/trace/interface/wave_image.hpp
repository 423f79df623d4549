// The wave image of light sorted by pupil cells, on the host in double.
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

// Beyond its border the image continues as its mirror image, with the pupil mirrored too, so that no light is lost. For
// an instrument that is symmetric about its axis the sum over the pixels stays the same; for others it changes by the
// part of the point spread's asymmetry that crosses the border.
class WaveImage {
  public:
    // pixels: the detector's. The filter must outlive it.
    WaveImage(const optics::PupilFilter& filter, ImageSize pixels);

    // The number of numbers of the sorted light: cell after cell, row after row of parts of pixels.
    std::size_t numbers() const;
    std::size_t numbers_a_cell() const { return size_.count(); }
    int columns() const { return size_.columns; } // numbers in a row
    // The light of the pixels, in the units of the sorted light.
    Grid<double> apply(std::span<const std::uint64_t> light) const;
    // Makes the light of the pixels from cells that the calling thread fetches one after the other and does not keep:
    // four times as many cells at a time as there are cores, and of each the rows of parts of pixels that a window of
    // the field's tiles needs.
    using RowsOfCell = std::function<std::vector<std::uint64_t>(int cell, int first_row, int rows)>;
    Grid<double> apply(const RowsOfCell& rows_of_cell) const;

  private:
    struct Spectrum;
    class Window;
    std::array<int, 4> mirror_images(int cell) const;

    const optics::PupilFilter& filter_;
    ImageSize pixels_;
    ImageSize size_; // parts of pixels
};

// Light that the host sorts; many threads may add to it at a time. Without a filter nothing is kept.
class CellLight {
  public:
    CellLight(const std::optional<optics::PupilFilter>& filter, ImageSize pixels);

    void add(const physics::f64::CellPlace& place, std::uint64_t light);
    Grid<double> image() const { return image_.value().apply(numbers_); }

  private:
    std::optional<WaveImage> image_;
    ImageSize size_; // parts of pixels
    std::vector<std::uint64_t> numbers_;
};

// The filter that the options ask for, for an instrument that is not reversed; none: images of rays.
std::optional<optics::PupilFilter> filter_for_waves(const optics::Instrument& instrument, const TraceOptions& options);

// The pixels with their light replaced by the wave image. light: from WaveImage::apply(), in units of power_per_number
// W.
PixelLight with_waves(PixelLight pixels, const Grid<double>& light, double power_per_number,
                      const optics::PupilFilter& filter);

} // namespace vkfv::trace
