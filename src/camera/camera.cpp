#include "camera/camera.hpp"

#include "camera/saturation.hpp"
#include "core/threads/parallel_rows.hpp"
#include "statistics/poisson.hpp"
#include "statistics/random_stream.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::camera {

using statistics::Purpose;
using statistics::RandomStream;

namespace {

// The constants are exact in the SI of 2019.
constexpr double planck = 6.62607015e-34;    // J s
constexpr double speed_of_light = 299792458; // m/s
constexpr double metres_per_um = 1e-6;

double square(double value) {
    return value * value;
}

} // namespace

double QuantumEfficiency::at(double wavelength_um) const {
    if (wavelengths_um.empty()) {
        return values.front();
    }
    const auto above = std::ranges::upper_bound(wavelengths_um, wavelength_um);
    const auto k = static_cast<std::size_t>(above - wavelengths_um.begin());
    if (k == 0 || k == wavelengths_um.size()) {
        return k == 0 ? values.front() : values.back();
    }
    const double share = (wavelength_um - wavelengths_um[k - 1]) / (wavelengths_um[k] - wavelengths_um[k - 1]);
    return std::lerp(values[k - 1], values[k], share);
}

bool QuantumEfficiency::covers(double shortest_um, double longest_um) const {
    return wavelengths_um.empty() || (wavelengths_um.front() <= shortest_um && wavelengths_um.back() >= longest_um);
}

Camera::Camera(const CameraOptions& options, const optics::Spectrum& spectrum)
    : options_(options), clip_(clip_of_capacity(options.full_well, options.photo_response)),
      highest_(std::exp2(options.bit_depth) - 1) {
    for (const auto& node : optics::spectral_nodes(spectrum.bins, spectrum.centre(), spectrum.half_width())) {
        const double photons = node.weight * node.wavelength_um * metres_per_um / (planck * speed_of_light);
        photons_per_joule_ += photons;
        electrons_per_joule_ += photons * options.quantum_efficiency.at(node.wavelength_um);
    }
}

FixedPattern Camera::fixed_pattern(int columns, int rows) const {
    FixedPattern pattern{.response = Grid<double>(columns, rows), .dark_signal = Grid<double>(columns, rows)};
    parallel_rows(columns, rows, [&](int first_row, int end_row) {
        const auto& grid = pattern.response;
        for (std::size_t k = grid.index(0, first_row); k < grid.index(0, end_row); ++k) {
            const auto pixel = static_cast<std::uint32_t>(k);
            const auto deviation = [&](Purpose purpose) {
                return RandomStream(options_.seed, 0, pixel, 0, purpose).normal();
            };
            pattern.response.values[k] = 1 + options_.photo_response * deviation(Purpose::photo_response);
            pattern.dark_signal.values[k] = options_.dark_signal * deviation(Purpose::dark_signal);
        }
    });
    return pattern;
}

Grid<float> Camera::image(const Grid<double>& flux, double exposure_time, std::uint32_t image,
                          const FixedPattern& pattern) const {
    Grid<float> values(flux.columns, flux.rows);
    const double electrons_per_watt = electrons_per_joule_ * exposure_time;
    const double dark_charge = options_.dark_current * exposure_time;
    const auto expose_rows = [&](int first_row, int end_row) {
        for (std::size_t k = flux.index(0, first_row); k < flux.index(0, end_row); ++k) {
            const auto pixel = static_cast<std::uint32_t>(k);
            const double light = flux.values[k] * electrons_per_watt * pattern.response.values[k];
            const double mean = std::max(0.0, light) + dark_charge;
            double sum = 0;
            for (int frame = 0; frame < options_.frames; ++frame) {
                RandomStream random(options_.noise_seed, image, pixel, static_cast<std::uint32_t>(frame),
                                    Purpose::temporal_noise);
                const double charge = std::min(statistics::poisson_count(mean, random), clip_);
                const double read = charge + pattern.dark_signal.values[k] + options_.read_noise * random.normal();
                sum += std::clamp(std::floor(options_.gain * read + options_.offset + 0.5), 0.0, highest_);
            }
            values.values[k] = static_cast<float>(sum / options_.frames);
        }
    };
    // A pixel takes a quarter of a microsecond, so that small images are worth many threads.
    constexpr int pixels_a_band = 4096;
    parallel_bands(flux.rows, std::max(1, pixels_a_band / std::max(1, flux.columns)), expose_rows);
    return values;
}

ImageLight Camera::light_of(const Grid<double>& flux, const Grid<double>& standard_error, double exposure_time) const {
    const double electrons_per_watt = electrons_per_joule_ * exposure_time;
    const auto count = static_cast<double>(flux.values.size());
    ImageLight light;
    double camera_variance = 0, ray_variance = 0;
    for (const double power : flux.values) {
        // Wave-filtered light of few rays may be below zero.
        const double electrons = std::max(0.0, power * electrons_per_watt);
        light.mean += electrons / count;
        if (electrons > saturation_charge()) {
            light.saturated_share += 1 / count;
        } else {
            camera_variance += square(temporal_noise(electrons + options_.dark_current * exposure_time)) / count;
        }
    }
    for (const double error : standard_error.values) {
        ray_variance += square(error * electrons_per_watt) / count;
    }
    light.camera_noise = std::sqrt(camera_variance / options_.frames);
    light.ray_noise = std::sqrt(ray_variance);
    return light;
}

double Camera::time_to(double share, double flux) const {
    return share * saturation_charge() / (flux * electrons_per_joule_);
}

Camera Camera::of_single_frames() const {
    Camera camera = *this;
    camera.options_.frames = 1;
    return camera;
}

double Camera::converter_end() const {
    return (highest_ - options_.offset) / options_.gain;
}

double Camera::saturation_charge() const {
    return std::min(options_.full_well, converter_end());
}

double Camera::quantisation_noise() const {
    return std::sqrt(1.0 / 12) / options_.gain;
}

double Camera::temporal_noise(double electrons) const {
    return std::sqrt(electrons + square(options_.read_noise) + square(quantisation_noise()));
}

double Camera::largest_signal_to_noise() const {
    return std::sqrt(options_.full_well);
}

double Camera::least_electrons() const {
    return temporal_noise(0) + 0.5;
}

double Camera::dynamic_range() const {
    return options_.full_well / least_electrons();
}

} // namespace vkfv::camera
