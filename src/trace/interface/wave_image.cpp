#include "trace/interface/wave_image.hpp"

#include "core/mathematics/complex_product.hpp"
#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"
#include "core/threads/parallel_list.hpp"
#include "trace/interface/wave_windows.hpp"

#include <algorithm>
#include <atomic>
#include <complex>

namespace vkfv::trace {

using Complex = std::complex<double>;

namespace {

ImageSize in_parts(ImageSize pixels, const optics::PupilFilter& filter) {
    const auto parts = static_cast<int>(filter.cells().parts);
    return {pixels.columns * parts, pixels.rows * parts};
}

} // namespace

// The spectrum of an extended window, whose periods are twice its sides: at l / (2 columns) and -l / (2 columns) cycles
// a part along x, m / (2 rows) along y, with its phase at the lower left corner of the first part, divided by 4.
struct WaveImage::Spectrum {
    Grid<Complex> ahead;
    Grid<Complex> behind;
};

// One window, with a spectrum for each filter.
class WaveImage::Window {
  public:
    // A cell and its mirror images (itself, left to right, upside down, both) are transformed together, by the parts of
    // their extended images that are even or odd along rows (x) and columns (y).
    enum Part : std::size_t { even, odd_along, odd_across, odd };
    using Parts = std::array<Grid<double>, 4>;
    using Rows = std::array<std::vector<std::uint64_t>, 4>; // window's rows of the four cells, over the whole image

    // image: its size in parts of pixels.
    Window(const optics::PupilFilter& filter, const WaveWindow& window, ImageSize image)
        : filter_(filter), window_(window), image_(image), size_(in_parts(window.size, filter)),
          sums_(static_cast<std::size_t>(window.filters),
                {Grid<Complex>(size_.columns, size_.rows), Grid<Complex>(size_.columns, size_.rows)}) {
        for (std::size_t k = 0; k < sums_.size(); ++k) {
            transfers_.push_back(filter.tile_transfers(window.tiles[k]));
        }
    }

    int first_row() const { return window_.row * parts(); }
    int rows() const { return size_.rows; }
    Parts transform(const Rows& images) const;
    void add(const Parts& parts, const std::array<int, 4>& cells);
    void add_pixels(Grid<double>& result) const;

  private:
    int parts() const { return static_cast<int>(filter_.cells().parts); }
    Grid<double> pixels_of(const Spectrum& sum) const;

    const optics::PupilFilter& filter_;
    const WaveWindow& window_;
    ImageSize image_;
    ImageSize size_; // parts of pixels
    std::vector<Spectrum> sums_;
    std::vector<optics::TileTransfers> transfers_; // transfer functions for each filter
};

WaveImage::WaveImage(const optics::PupilFilter& filter, ImageSize pixels)
    : filter_(filter), pixels_(pixels), size_(in_parts(pixels, filter)) {}

std::size_t WaveImage::numbers() const {
    return static_cast<std::size_t>(filter_.cell_count()) * size_.count();
}

std::array<int, 4> WaveImage::mirror_images(int cell) const {
    const int upright = filter_.mirrored_upright(cell);
    return {cell, filter_.mirrored(cell), upright, filter_.mirrored(upright)};
}

WaveImage::Window::Parts WaveImage::Window::transform(const Rows& images) const {
    Parts parts;
    parts.fill(Grid<double>(size_.columns, size_.rows));
    const int first_column = window_.column * this->parts();
    for (int row = 0; row < size_.rows; ++row) {
        for (int column = 0; column < size_.columns; ++column) {
            const std::size_t from = static_cast<std::size_t>(row) * static_cast<std::size_t>(image_.columns) +
                                     static_cast<std::size_t>(first_column + column);
            const std::size_t k = static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.columns) +
                                  static_cast<std::size_t>(column);
            const auto own = static_cast<double>(images[0][from]);
            const auto sideways = static_cast<double>(images[1][from]);
            const auto upright = static_cast<double>(images[2][from]);
            const auto both = static_cast<double>(images[3][from]);
            // A sine transform is the cosine transform of alternating signs, read from the other end.
            const double along = column % 2 == 0 ? 0.25 : -0.25;
            const double across = row % 2 == 0 ? 1 : -1;
            parts[even].values[k] = 0.25 * (own + sideways + upright + both);
            parts[odd_along].values[k] = along * (own - sideways + upright - both);
            parts[odd_across].values[k] = 0.25 * across * (own + sideways - upright - both);
            parts[odd].values[k] = along * across * (own - sideways - upright + both);
        }
    }
    for (Grid<double>& part : parts) {
        cosine_transform(part);
    }
    return parts;
}

void WaveImage::Window::add(const Parts& parts, const std::array<int, 4>& cells) {
    const double step_x = 0.5 / size_.columns / filter_.part_pitch();
    const double step_y = 0.5 / size_.rows / filter_.part_pitch();
    for (int row = 0; row < size_.rows; ++row) {
        for (int column = 0; column < size_.columns; ++column) {
            const double fx = column * step_x;
            const double fy = row * step_y;
            if (fx * fx + fy * fy < filter_.cutoff() * filter_.cutoff()) {
                const double cosines = parts[even](column, row);
                const double sine_along = column > 0 ? parts[odd_along](size_.columns - column, row) : 0.0;
                const double sine_across = row > 0 ? parts[odd_across](column, size_.rows - row) : 0.0;
                const double sines = column > 0 && row > 0 ? parts[odd](size_.columns - column, size_.rows - row) : 0.0;
                // A sine changes its sign where its frequency does; mirrored light has it reversed.
                const Complex same(cosines - sines, -sine_along - sine_across);
                const Complex sideways(cosines + sines, sine_along - sine_across);
                const std::array ahead = {same, sideways, std::conj(sideways), std::conj(same)};
                const std::array behind = {sideways, same, std::conj(same), std::conj(sideways)};
                const optics::TablePlace place_ahead = transfers_.front().place(fx, fy);
                const optics::TablePlace place_behind = transfers_.front().place(-fx, fy);
                for (std::size_t filter = 0; filter < sums_.size(); ++filter) {
                    const optics::TileTransfers& transfers = transfers_[filter];
                    Complex& sum_ahead = sums_[filter].ahead(column, row);
                    Complex& sum_behind = sums_[filter].behind(column, row);
                    for (std::size_t k = 0; k < cells.size(); ++k) {
                        sum_ahead += product(transfers.at(cells[k], place_ahead), ahead[k]);
                        sum_behind += product(transfers.at(cells[k], place_behind), behind[k]);
                    }
                }
            }
        }
    }
}

Grid<double> WaveImage::Window::pixels_of(const Spectrum& sum) const {
    const int period_x = 2 * size_.columns;
    const int period_y = 2 * size_.rows;
    Grid<Complex> whole(period_x, period_y);
    for (int row = 0; row < size_.rows; ++row) {
        for (int column = 0; column < size_.columns; ++column) {
            // The phase moves from the corner to the middle of the first part; a cosine counted once stands at two
            // frequencies.
            const double along = pi * column / period_x;
            const double across = pi * row / period_y;
            const Complex ahead = 4.0 * std::polar(1.0, across + along) * sum.ahead(column, row);
            const Complex behind = 4.0 * std::polar(1.0, across - along) * sum.behind(column, row);
            const int left = (period_x - column) % period_x;
            const int low = (period_y - row) % period_y;
            whole(column, row) = ahead;
            whole(left, row) = column > 0 ? behind : ahead;
            if (row > 0) {
                whole(left, low) = std::conj(ahead);
                whole(column, low) = std::conj(column > 0 ? behind : ahead);
            }
        }
    }
    inverse_fourier_transform(whole);
    Grid<double> result(window_.size.columns, window_.size.rows);
    for (int row = 0; row < size_.rows; ++row) {
        for (int column = 0; column < size_.columns; ++column) {
            const double sensitive =
                physics::f64::sensitive_share(filter_.cells(), static_cast<std::uint32_t>(column % parts())) *
                physics::f64::sensitive_share(filter_.cells(), static_cast<std::uint32_t>(row % parts()));
            result(column / parts(), row / parts()) += sensitive * whole(column, row).real();
        }
    }
    return result;
}

void WaveImage::Window::add_pixels(Grid<double>& result) const {
    for (std::size_t filter = 0; filter < sums_.size(); ++filter) {
        const Grid<double> pixels = pixels_of(sums_[filter]);
        for (int row = 0; row < pixels.rows; ++row) {
            for (int column = 0; column < pixels.columns; ++column) {
                const double weight = weights_at(window_, window_.column + column, window_.row + row)[filter];
                result(window_.column + column, window_.row + row) += weight * pixels(column, row);
            }
        }
    }
}

Grid<double> WaveImage::apply(std::span<const std::uint64_t> light) const {
    return apply([&](int cell, int first_row, int rows) {
        const auto columns = static_cast<std::size_t>(size_.columns);
        const auto part = light.subspan(static_cast<std::size_t>(cell) * numbers_a_cell() +
                                            static_cast<std::size_t>(first_row) * columns,
                                        static_cast<std::size_t>(rows) * columns);
        return std::vector<std::uint64_t>(part.begin(), part.end());
    });
}

Grid<double> WaveImage::apply(const RowsOfCell& rows_of_cell) const {
    std::vector<std::array<int, 4>> groups;
    for (int cell = 0; cell < filter_.cell_count(); ++cell) {
        if (cell < filter_.mirrored(cell) && cell < filter_.mirrored_upright(cell)) {
            groups.push_back(mirror_images(cell));
        }
    }
    Grid<double> result(pixels_.columns, pixels_.rows);
    for (const WaveWindow& place :
         wave_windows(filter_.tiles().across(), pixels_, static_cast<int>(filter_.cells().parts))) {
        Window window(filter_, place, size_);
        // Cells are transformed side by side and added up in their order, so that the bits do not depend on the number
        // of cores.
        const auto cores = static_cast<std::size_t>(core_count());
        for (std::size_t first = 0; first < groups.size(); first += cores) {
            const std::size_t count = std::min(cores, groups.size() - first);
            std::vector<Window::Rows> images(count);
            for (std::size_t k = 0; k < count; ++k) {
                std::ranges::transform(groups[first + k], images[k].begin(),
                                       [&](int cell) { return rows_of_cell(cell, window.first_row(), window.rows()); });
            }
            const std::vector<Window::Parts> transformed = parallel_list(
                static_cast<int>(count), [&](int k) { return window.transform(images[static_cast<std::size_t>(k)]); });
            for (std::size_t k = 0; k < count; ++k) {
                window.add(transformed[k], groups[first + k]);
            }
        }
        window.add_pixels(result);
    }
    return result;
}

CellLight::CellLight(const std::optional<optics::PupilFilter>& filter, ImageSize pixels) {
    if (filter) {
        image_.emplace(*filter, pixels);
        size_ = in_parts(pixels, *filter);
        numbers_.resize(image_->numbers());
    }
}

void CellLight::add(const physics::f64::CellPlace& place, std::uint64_t light) {
    std::uint64_t& number = numbers_[place.cell * size_.count() +
                                     static_cast<std::size_t>(place.row) * static_cast<std::size_t>(size_.columns) +
                                     static_cast<std::size_t>(place.column)];
    std::atomic_ref(number).fetch_add(light, std::memory_order_relaxed);
}

std::optional<optics::PupilFilter> filter_for_waves(const optics::Instrument& instrument, const TraceOptions& options) {
    return options.waves && !options.nonsequential
               ? std::optional<optics::PupilFilter>(std::in_place, instrument, *options.waves)
               : std::nullopt;
}

PixelLight with_waves(PixelLight pixels, const Grid<double>& light, double power_per_number,
                      const optics::PupilFilter& filter) {
    const double noise = filter.noise();
    for (std::size_t pixel = 0; pixel < light.values.size(); ++pixel) {
        pixels.flux.values[pixel] = power_per_number * light.values[pixel];
        pixels.standard_error.values[pixel] *= noise;
    }
    return pixels;
}

} // namespace vkfv::trace
