#include "topography/fringes.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "core/threads/parallel_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <utility>

namespace vkfv::topography {

namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
constexpr double dark_share = 0.01;       // of the stack's mean brightness
constexpr double least_modulation = 1e-4; // of the brightness: images in single precision have a noise of 1e-7
constexpr double least_over_noise = 6;    // amplitude over its standard deviation: 1e-8 of the points pass by chance

double wrapped(double phase) {
    return phase - 2 * pi * std::round(phase / (2 * pi));
}

} // namespace

FringeBandTransform::FringeBandTransform(int images, double step, double least, double most)
    : images_(images), step_(step) {
    const double apart = 2 * pi / (images * step);
    // A signal as short as the scan spreads by one multiple to either side.
    for (int k = std::max(1, static_cast<int>(std::floor(least / apart))); (k - 1) * apart <= most && 2 * k < images;
         ++k) {
        wave_numbers_.push_back(k * apart);
    }
    for (const double wave_number : wave_numbers_) {
        for (int image = 0; image < images; ++image) {
            cosines_.push_back(std::cos(wave_number * step * image));
            sines_.push_back(std::sin(wave_number * step * image));
        }
    }
}

FringeBandTransform::Spectrum FringeBandTransform::transform(const std::vector<double>& signal) const {
    Spectrum spectrum;
    spectrum.mean = std::accumulate(signal.begin(), signal.end(), 0.0) / images_;
    for (const double value : signal) {
        spectrum.energy += (value - spectrum.mean) * (value - spectrum.mean);
    }
    const auto count = static_cast<std::size_t>(images_);
    for (std::size_t bin = 0; bin < wave_numbers_.size(); ++bin) {
        double real = 0, imaginary = 0;
        for (std::size_t image = 0; image < count; ++image) {
            real += signal[image] * cosines_[bin * count + image];
            imaginary -= signal[image] * sines_[bin * count + image];
        }
        spectrum.real.push_back(real);
        spectrum.imaginary.push_back(imaginary);
    }
    return spectrum;
}

std::vector<double> FringeBandTransform::envelope(const std::vector<double>& signal) const {
    const Spectrum spectrum = transform(signal);
    const auto count = static_cast<std::size_t>(images_);
    std::vector<double> result(count);
    for (std::size_t image = 0; image < count; ++image) {
        double real = 0, imaginary = 0;
        for (std::size_t bin = 0; bin < wave_numbers_.size(); ++bin) {
            const double c = cosines_[bin * count + image], s = sines_[bin * count + image];
            real += spectrum.real[bin] * c - spectrum.imaginary[bin] * s;
            imaginary += spectrum.real[bin] * s + spectrum.imaginary[bin] * c;
        }
        result[image] = 2 * std::hypot(real, imaginary) / images_;
    }
    return result;
}

FringeFit FringeBandTransform::fit(const std::vector<double>& signal, double first) const {
    FringeFit fit;
    const Spectrum spectrum = transform(signal);
    const auto height = envelope(signal);
    const auto top = std::ranges::max_element(height);
    fit.image = static_cast<int>(top - height.begin());
    fit.amplitude = *top;
    fit.at = first + fit.image * step_;
    double energy = 0, highest = 0;
    std::vector<double> squares; // of the bins' moduli
    for (std::size_t bin = 0; bin < wave_numbers_.size(); ++bin) {
        squares.push_back(std::norm(std::complex(spectrum.real[bin], spectrum.imaginary[bin])));
        highest = std::max(highest, squares.back());
        energy += 2 * squares.back() / images_;
    }
    const double free = images_ - 1.0 - 2.0 * bins();
    fit.noise = free > 0 ? std::sqrt(std::max(0.0, spectrum.energy - energy) / free) : 0;
    const double of_bin = fit.noise * fit.noise * images_ / 2; // variance of the real part of a bin
    // Bins whose phase is nearly that of noise would add more of it than their weight says.
    constexpr double least_share = 0.01, least_over_noise_of_bin = 10;
    const double least = std::max(least_share * highest, least_over_noise_of_bin * 2 * of_bin);
    std::vector<double> bin_weights;
    double weights = 0;
    for (std::size_t bin = 0; bin < wave_numbers_.size(); ++bin) {
        bin_weights.push_back(squares[bin] >= std::min(least, highest) ? squares[bin] : 0);
        weights += bin_weights.back();
        fit.mean_wave_number += bin_weights.back() * wave_numbers_[bin];
    }
    fit.mean_wave_number /= weights;
    // The phases near the highest envelope lie on a line through nearly the phase of their sum, so that they need no
    // unwrapping but about that.
    std::complex<double> sum = 0;
    std::vector<std::complex<double>> turned;
    for (std::size_t bin = 0; bin < wave_numbers_.size(); ++bin) {
        turned.push_back(std::complex(spectrum.real[bin], spectrum.imaginary[bin]) *
                         std::polar(1.0, wave_numbers_[bin] * step_ * fit.image));
        sum += bin_weights[bin] > 0 ? turned.back() : 0;
    }
    const double middle = std::arg(sum);
    double offset = 0, moment = 0, spread = 0;
    std::vector<double> phases;
    for (std::size_t bin = 0; bin < wave_numbers_.size(); ++bin) {
        const double weight = bin_weights[bin], apart = wave_numbers_[bin] - fit.mean_wave_number;
        phases.push_back(std::arg(turned[bin] * std::polar(1.0, -middle)));
        offset += weight * phases.back();
        moment += weight * apart * phases.back();
        spread += weight * apart * apart;
    }
    offset /= weights;
    const double slope = moment / spread;
    fit.wave_number_deviation = std::sqrt(spread / weights);
    double residual = 0;
    for (std::size_t bin = 0; bin < wave_numbers_.size(); ++bin) {
        const double apart = wave_numbers_[bin] - fit.mean_wave_number;
        residual += bin_weights[bin] * std::pow(phases[bin] - offset - slope * apart, 2);
    }
    fit.residual = std::sqrt(residual / weights);
    fit.phase = wrapped(middle + offset);
    fit.envelope_height = fit.at - slope;
    fit.slope_deviation = std::sqrt(of_bin / spread);
    fit.phase_deviation = std::sqrt(of_bin / weights);
    return fit;
}

void FringeEvaluator::add(const Channels& image, double z, std::optional<double> reading) {
    if (image.size() != 1 || (!images_.empty() && (image.front().columns != images_.front().columns ||
                                                   image.front().rows != images_.front().rows))) {
        throw InputError({.where = {},
                          .key = "image",
                          .found = fmt::format("{} channels of other sizes", image.size()),
                          .expected = "grey images of one size",
                          .remedy = "Give such images: fringes of each colour need a stack of their own."});
    }
    images_.push_back(image.front());
    z_.push_back(z);
    if (reading) {
        readings_.push_back(*reading);
    }
}

Topography FringeEvaluator::finish(double x0, double y0, double pitch) {
    const int images = static_cast<int>(images_.size());
    if (images < 8) {
        throw InputError({.where = {},
                          .key = "stack",
                          .found = fmt::format("{} images", images),
                          .expected = "at least 8 images of fringes",
                          .remedy = "Scan farther, or in smaller steps."});
    }
    const double step = (z_.back() - z_.front()) / (images - 1);
    const FringeBandTransform band(images, step, options_.least_wave_number, options_.most_wave_number);
    if (band.bins() < 2) {
        throw InputError({.where = {},
                          .key = "scan.z_stop_um",
                          .found = fmt::format("a scan of {:.4g} um", images * step * um_per_mm),
                          .expected = "a scan over several fringes",
                          .remedy = "Scan farther."});
    }
    const int columns = images_.front().columns, rows = images_.front().rows;
    Topography result;
    result.height = {
        .height = Grid<double>(columns, rows, nothing), .x0 = x0, .y0 = y0, .pitch_x = pitch, .pitch_y = pitch};
    result.contrast = result.fit_residual = Grid<double>(columns, rows);
    result.height_noise = result.height_uncertainty = result.height.height;
    result.peaks = Grid<std::uint16_t>(columns, rows, 1);
    result.state = Grid<PointState>(columns, rows, PointState::measured);
    Grid<float> brightness(columns, rows);
    Grid<FringeFit> fits(columns, rows);
    const auto signal_of = [&](std::size_t pixel) {
        std::vector<double> signal(static_cast<std::size_t>(images));
        for (std::size_t image = 0; image < signal.size(); ++image) {
            signal[image] = static_cast<double>(images_[image].values[pixel]);
        }
        return signal;
    };
    parallel_rows(columns, rows, [&](int begin, int end) {
        for (std::size_t pixel = fits.index(0, begin); pixel < fits.index(0, end); ++pixel) {
            const auto signal = signal_of(pixel);
            brightness.values[pixel] = static_cast<float>(std::accumulate(signal.begin(), signal.end(), 0.0) / images);
            fits.values[pixel] = band.fit(signal, z_.front());
        }
    });
    const double mean = std::accumulate(brightness.values.begin(), brightness.values.end(), 0.0) /
                        static_cast<double>(brightness.values.size());
    std::complex<double> gaps = 0; // phase of the fringes at the envelope's middle
    const double envelope_noise = 2 * std::sqrt(band.bins() / (2.0 * images));
    for (std::size_t pixel = 0; pixel < fits.values.size(); ++pixel) {
        const FringeFit& fit = fits.values[pixel];
        PointState& state = result.state.values[pixel];
        const double noise = fit.noise * envelope_noise;
        result.contrast.values[pixel] = noise > 0 ? fit.amplitude / noise : std::numeric_limits<double>::infinity();
        result.fit_residual.values[pixel] = std::min(1.0, fit.residual);
        if (!(static_cast<double>(brightness.values[pixel]) > dark_share * mean)) {
            state = PointState::dark;
        } else if (!(fit.amplitude > least_over_noise * noise) ||
                   !(fit.amplitude > least_modulation * static_cast<double>(brightness.values[pixel]))) {
            state = PointState::by_chance;
        } else if (fit.envelope_height < z_.front() || fit.envelope_height > z_.back() || fit.image == 0 ||
                   fit.image == images - 1) {
            state = PointState::no_peak;
        } else {
            gaps += fit.amplitude * std::polar(1.0, fit.phase - fit.mean_wave_number * (fit.at - fit.envelope_height));
        }
    }
    const double gap = std::arg(gaps);
    const bool by_phase = options_.method == HeightMethod::phase;
    for (std::size_t pixel = 0; pixel < fits.values.size(); ++pixel) {
        const FringeFit& fit = fits.values[pixel];
        if (result.state.values[pixel] != PointState::measured) {
            continue;
        }
        double height = fit.envelope_height, noise = fit.slope_deviation;
        double bend = fit.residual / fit.wave_number_deviation;
        const double apart =
            wrapped(fit.phase - fit.mean_wave_number * (fit.at - fit.envelope_height) - gap) / fit.mean_wave_number;
        const double disagreement = std::sqrt(std::max(0.0, apart * apart - noise * noise));
        if (by_phase) {
            height -= apart;
            noise = fit.phase_deviation / fit.mean_wave_number;
            bend = fit.residual / fit.mean_wave_number;
        }
        if (!readings_.empty()) { // heights by the scale's readings, linear between them
            const double place = std::clamp((height - z_.front()) / step, 0.0, images - 1.0);
            const auto below = std::min(static_cast<std::size_t>(place), readings_.size() - 2);
            const double share = (height - z_.front()) / step - static_cast<double>(below);
            height = readings_[below] + share * (readings_[below + 1] - readings_[below]);
        }
        result.height.height.values[pixel] = height;
        result.height_noise.values[pixel] = noise;
        result.height_uncertainty.values[pixel] = std::hypot(noise, bend, disagreement);
    }
    result.stack.smoothing_steps = 0;
    double noise = 0;
    for (const FringeFit& fit : fits.values) {
        noise += fit.noise * fit.noise;
    }
    result.stack.image_noise = mean > 0 ? std::sqrt(noise / static_cast<double>(fits.values.size())) / mean : 0;
    result.all_in_focus = {brightness};
    // The kept curves are the signals themselves, which show the fringes.
    result.curves.columns = grid_.columns_of(columns);
    result.curves.rows = grid_.rows_of(rows);
    for (int image = 0; image < images; image += grid_.every) {
        result.curves.z.push_back(z_[static_cast<std::size_t>(image)]);
    }
    for (const int row : result.curves.rows) {
        for (const int column : result.curves.columns) {
            for (int image = 0; image < images; image += grid_.every) {
                result.curves.values.push_back(images_[static_cast<std::size_t>(image)](column, row));
            }
            result.curves.peaks.push_back(result.height.height(column, row));
            result.curves.fits.emplace_back();
        }
    }
    return result;
}

} // namespace vkfv::topography
