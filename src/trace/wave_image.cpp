#include "trace/wave_image.hpp"

#include "core/fourier.hpp"
#include "core/units.hpp"

#include <algorithm>
#include <atomic>
#include <complex>
#include <thread>

namespace vkfv::trace {

using Complex = std::complex<double>;

// Of the extended image, whose period is twice the image's side: at (l, m) and (-l, m) / (2 side) cycles a part, as
// seen from the middle of its first part's lower left corner, over 4.
struct WaveImage::Spectrum {
    Grid<Complex> ahead;
    Grid<Complex> behind;
};

WaveImage::WaveImage(const optics::PupilFilter& filter, int pixels)
    : filter_(filter), pixels_(pixels), side_(pixels * static_cast<int>(filter.cells().parts)) {}

std::size_t WaveImage::numbers() const {
    return static_cast<std::size_t>(filter_.cell_count()) * static_cast<std::size_t>(side_) *
           static_cast<std::size_t>(side_);
}

std::array<int, 4> WaveImage::mirror_images(int cell) const {
    const int upright = filter_.mirrored_upright(cell);
    return {cell, filter_.mirrored(cell), upright, filter_.mirrored(upright)};
}

WaveImage::Parts WaveImage::transform(std::span<const std::uint64_t> light, const std::array<int, 4>& cells) const {
    const std::size_t count = static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
    const auto image = [&](std::size_t k) { return light.subspan(static_cast<std::size_t>(cells[k]) * count, count); };
    const std::array images = {image(0), image(1), image(2), image(3)};
    Parts parts;
    parts.fill(Grid<double>(side_, side_));
    for (int row = 0; row < side_; ++row) {
        for (int column = 0; column < side_; ++column) {
            const std::size_t k =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(column);
            const auto own = static_cast<double>(images[0][k]);
            const auto sideways = static_cast<double>(images[1][k]);
            const auto upright = static_cast<double>(images[2][k]);
            const auto both = static_cast<double>(images[3][k]);
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

void WaveImage::add(Spectrum& sum, const Parts& parts, const std::array<int, 4>& cells) const {
    const double step = 0.5 / side_ / filter_.part_pitch();
    for (int row = 0; row < side_; ++row) {
        for (int column = 0; column < side_; ++column) {
            const double fx = column * step;
            const double fy = row * step;
            if (fx * fx + fy * fy < filter_.cutoff() * filter_.cutoff()) {
                const double cosines = parts[even](column, row);
                const double sine_along = column > 0 ? parts[odd_along](side_ - column, row) : 0.0;
                const double sine_across = row > 0 ? parts[odd_across](column, side_ - row) : 0.0;
                const double sines = column > 0 && row > 0 ? parts[odd](side_ - column, side_ - row) : 0.0;
                // A sine changes its sign where its frequency does; mirrored light has it reversed.
                const Complex same(cosines - sines, -sine_along - sine_across);
                const Complex sideways(cosines + sines, sine_along - sine_across);
                const std::array ahead = {same, sideways, std::conj(sideways), std::conj(same)};
                const std::array behind = {sideways, same, std::conj(same), std::conj(sideways)};
                for (std::size_t k = 0; k < cells.size(); ++k) {
                    sum.ahead(column, row) += filter_.transfer(cells[k], fx, fy) * ahead[k];
                    sum.behind(column, row) += filter_.transfer(cells[k], -fx, fy) * behind[k];
                }
            }
        }
    }
}

Grid<double> WaveImage::pixels_of(const Spectrum& sum) const {
    const int period = 2 * side_;
    Grid<Complex> whole(period, period);
    for (int row = 0; row < side_; ++row) {
        for (int column = 0; column < side_; ++column) {
            // From the corner to the middle of the first part; what cosines count once stands at two frequencies.
            const Complex ahead = 4.0 * std::polar(1.0, pi * (column + row) / period) * sum.ahead(column, row);
            const Complex behind = 4.0 * std::polar(1.0, pi * (row - column) / period) * sum.behind(column, row);
            const int left = (period - column) % period;
            const int low = (period - row) % period;
            whole(column, row) = ahead;
            whole(left, row) = column > 0 ? behind : ahead;
            if (row > 0) {
                whole(left, low) = std::conj(ahead);
                whole(column, low) = std::conj(column > 0 ? behind : ahead);
            }
        }
    }
    inverse_fourier_transform(whole);
    const int parts = side_ / pixels_;
    Grid<double> result(pixels_, pixels_);
    for (int row = 0; row < side_; ++row) {
        for (int column = 0; column < side_; ++column) {
            result(column / parts, row / parts) += whole(column, row).real();
        }
    }
    return result;
}

Grid<double> WaveImage::apply(std::span<const std::uint64_t> light) const {
    std::vector<std::array<int, 4>> groups;
    for (int cell = 0; cell < filter_.cell_count(); ++cell) {
        if (cell < filter_.mirrored(cell) && cell < filter_.mirrored_upright(cell)) {
            groups.push_back(mirror_images(cell));
        }
    }
    Spectrum sum{Grid<Complex>(side_, side_), Grid<Complex>(side_, side_)};
    // Transformed side by side, added up in their order: the same bits on any number of cores.
    const std::size_t workers = std::max(1u, std::thread::hardware_concurrency());
    for (std::size_t first = 0; first < groups.size(); first += workers) {
        const std::size_t count = std::min(workers, groups.size() - first);
        std::vector<Parts> transformed(count);
        {
            std::vector<std::jthread> threads;
            for (std::size_t k = 0; k < count; ++k) {
                threads.emplace_back([&, k] { transformed[k] = transform(light, groups[first + k]); });
            }
        }
        for (std::size_t k = 0; k < count; ++k) {
            add(sum, transformed[k], groups[first + k]);
        }
    }
    return pixels_of(sum);
}

CellLight::CellLight(const std::optional<optics::PupilFilter>& filter, int pixels) {
    if (filter) {
        image_.emplace(*filter, pixels);
        side_ = static_cast<std::size_t>(pixels) * filter->cells().parts;
        numbers_.resize(image_->numbers());
    }
}

void CellLight::add(const physics::f64::CellPlace& place, std::uint64_t light) {
    std::uint64_t& number = numbers_[(place.cell * side_ + static_cast<std::size_t>(place.row)) * side_ +
                                     static_cast<std::size_t>(place.column)];
    std::atomic_ref(number).fetch_add(light, std::memory_order_relaxed);
}

std::optional<optics::PupilFilter> filter_for_waves(const optics::Instrument& instrument, const TraceOptions& options) {
    return options.waves && !options.nonsequential
               ? std::optional<optics::PupilFilter>(std::in_place, instrument, *options.waves)
               : std::nullopt;
}

Image with_waves(Image image, const Grid<double>& light, double power_per_number, const optics::PupilFilter& filter) {
    const double noise = filter.noise();
    for (std::size_t pixel = 0; pixel < light.values.size(); ++pixel) {
        image.flux.values[pixel] = power_per_number * light.values[pixel];
        image.standard_error.values[pixel] *= noise;
    }
    return image;
}

} // namespace vkfv::trace
