#include "trace/wave_image.hpp"

#include "core/fourier.hpp"
#include "core/units.hpp"

#include <algorithm>
#include <atomic>
#include <complex>
#include <thread>
#include <utility>

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

WaveImage::Pair WaveImage::transform(std::span<const std::uint64_t> light, int cell, int mirrored) const {
    const std::size_t count = static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_);
    const auto first = light.subspan(static_cast<std::size_t>(cell) * count, count);
    const auto second = light.subspan(static_cast<std::size_t>(mirrored) * count, count);
    Pair pair{Grid<double>(side_, side_), Grid<double>(side_, side_)};
    for (int row = 0; row < side_; ++row) {
        for (int column = 0; column < side_; ++column) {
            const std::size_t k =
                static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(column);
            const auto own = static_cast<double>(first[k]);
            const auto other = static_cast<double>(second[k]);
            pair.even.values[k] = 0.5 * (own + other);
            // A sine transform is the cosine transform of alternating signs, read from the other end.
            pair.odd.values[k] = ((row + column) % 2 == 0 ? 0.5 : -0.5) * (own - other);
        }
    }
    cosine_transform(pair.even);
    cosine_transform(pair.odd);
    return pair;
}

void WaveImage::add(Spectrum& sum, const Pair& pair, int cell, int mirrored) const {
    const double step = 0.5 / side_ / filter_.part_pitch();
    for (int row = 0; row < side_; ++row) {
        for (int column = 0; column < side_; ++column) {
            const double fx = column * step;
            const double fy = row * step;
            if (fx * fx + fy * fy < filter_.cutoff() * filter_.cutoff()) {
                const double even = pair.even(column, row);
                const double odd = column > 0 && row > 0 ? pair.odd(side_ - column, side_ - row) : 0.0;
                // The product of two sines changes its sign where one frequency does; mirrored light has it reversed.
                sum.ahead(column, row) +=
                    filter_.transfer(cell, fx, fy) * (even - odd) + filter_.transfer(mirrored, fx, fy) * (even + odd);
                sum.behind(column, row) +=
                    filter_.transfer(cell, -fx, fy) * (even + odd) + filter_.transfer(mirrored, -fx, fy) * (even - odd);
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
    std::vector<std::pair<int, int>> pairs;
    for (int cell = 0; cell < filter_.cell_count(); ++cell) {
        if (const int mirrored = filter_.mirrored(cell); cell < mirrored) {
            pairs.emplace_back(cell, mirrored);
        }
    }
    Spectrum sum{Grid<Complex>(side_, side_), Grid<Complex>(side_, side_)};
    // Transformed side by side, added up in their order: the same bits on any number of cores.
    const std::size_t workers = std::max(1u, std::thread::hardware_concurrency());
    for (std::size_t first = 0; first < pairs.size(); first += workers) {
        const std::size_t count = std::min(workers, pairs.size() - first);
        std::vector<Pair> transformed(count);
        {
            std::vector<std::jthread> threads;
            for (std::size_t k = 0; k < count; ++k) {
                threads.emplace_back(
                    [&, k] { transformed[k] = transform(light, pairs[first + k].first, pairs[first + k].second); });
            }
        }
        for (std::size_t k = 0; k < count; ++k) {
            add(sum, transformed[k], pairs[first + k].first, pairs[first + k].second);
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
