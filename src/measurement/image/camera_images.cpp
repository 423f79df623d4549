#include "measurement/image/camera_images.hpp"

#include "core/messages/error.hpp"
#include "core/messages/json_text.hpp"
#include "measurement/image/camera_report.hpp"
#include "measurement/image/exposure.hpp"
#include "measurement/scene/assembly.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace vkfv::measurement {

namespace {

// Limits of the probe that sets the exposure time, and of the squares in which its light is averaged.
constexpr int most_probes = 5;
constexpr std::uint64_t most_probe_rays = 20'000'000;
constexpr std::uint32_t first_probe_image = 1u << 31; // keys random numbers that no image of a stack has
constexpr double noise_of_squares = 0.02, outshone_share = 0.999;

constexpr double most_ray_noise = 1.0 / 3; // share of the camera's noise
constexpr double most_saturated = 1e-3;

Grid<double> blurred(const optics::Diffraction& diffraction, const Grid<double>& flux) {
    const Grid<float> light = diffraction.apply(scan::as_stored(flux));
    Grid<double> result(light.columns, light.rows);
    std::ranges::copy(light.values, result.values.begin());
    return result;
}

// Evenly spread heights, with the first and the last among them.
std::vector<double> probe_heights(std::span<const double> heights) {
    const auto count = std::min<std::size_t>(heights.size(), most_probes);
    std::vector<double> chosen;
    for (std::size_t k = 0; k < count; ++k) {
        chosen.push_back(heights[count == 1 ? 0 : k * (heights.size() - 1) / (count - 1)]);
    }
    return chosen;
}

// The means of squares with this number of pixels a side. Pixels that fill no square, at the right and the top, are
// left out.
std::vector<double> means_of_squares(const Grid<double>& values, int side) {
    std::vector<double> means;
    for (int row = 0; row + side <= values.rows; row += side) {
        for (int column = 0; column + side <= values.columns; column += side) {
            double sum = 0;
            for (int y = row; y < row + side; ++y) {
                for (int x = column; x < column + side; ++x) {
                    sum += values(x, y);
                }
            }
            means.push_back(sum / side / side);
        }
    }
    return means;
}

} // namespace

nlohmann::ordered_json CameraNote::json() const {
    return {{"exposure_s", exposure_time},
            {"light_e", light.mean},
            {"camera_noise_e", light.camera_noise},
            {"ray_noise_e", light.ray_noise},
            {"saturated_share", light.saturated_share}};
}

std::string CameraNote::text() const {
    return json_text(json(), JsonLayout::one_line);
}

std::optional<CameraNote> CameraNote::parse(const std::string& text) {
    const auto json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_object()) {
        return std::nullopt;
    }
    const auto number = [&](const char* key) { // JSON has null for numbers that are not finite
        const auto found = json.find(key);
        return found != json.end() && found->is_number() ? found->get<double>()
                                                         : std::numeric_limits<double>::quiet_NaN();
    };
    return CameraNote{.exposure_time = number("exposure_s"),
                      .light = {.mean = number("light_e"),
                                .camera_noise = number("camera_noise_e"),
                                .ray_noise = number("ray_noise_e"),
                                .saturated_share = number("saturated_share")}};
}

ImagingCamera::ImagingCamera(const Configuration& configuration, const optics::Instrument& instrument,
                             double its_exposure_time)
    : configuration_(configuration), camera_(configuration.camera.value(), configuration.instrument.spectrum),
      pattern_(camera_.fixed_pattern(configuration.instrument.detector_pixels.columns,
                                     configuration.instrument.detector_pixels.rows)),
      diffraction_(make_diffraction(configuration, instrument)), exposure_time_(its_exposure_time) {}

scan::Frame ImagingCamera::develop(int image, const trace::Image& exposure) const {
    const auto take = [&](const Grid<double>& flux) {
        auto light = camera_.light_of(flux, exposure.standard_error, exposure_time_);
        if (configuration_.pixel_type != scan::PixelType::float32 && camera_.options().frames > 1) {
            light.camera_noise =
                std::hypot(light.camera_noise, camera_.quantisation_noise()); // the mean of the frames is rounded too
        }
        return scan::Frame{
            .values = scan::as_stored(camera_.image(flux, exposure_time_, static_cast<std::uint32_t>(image), pattern_),
                                      configuration_.pixel_type),
            .note = CameraNote{.exposure_time = exposure_time_, .light = light}.text()};
    };
    return diffraction_ ? take(blurred(*diffraction_, exposure.flux)) : take(exposure.flux);
}

double exposure_time(const Configuration& configuration, const optics::Instrument& instrument,
                     const specimen::Specimen& specimen, std::span<const double> focal_heights,
                     const WorkingDevices& devices) {
    const camera::CameraOptions& options = configuration.camera.value();
    if (options.control == camera::ExposureControl::time) {
        return options.exposure_time;
    }
    const auto heights = options.control == camera::ExposureControl::first ? std::vector{focal_heights.front()}
                                                                           : probe_heights(focal_heights);
    auto few_rays = configuration.trace;
    few_rays.rays = std::clamp<std::uint64_t>(few_rays.rays / heights.size(), 1, most_probe_rays);
    const auto tracer = devices.first().make_tracer(instrument, specimen, few_rays);
    const auto diffraction = make_diffraction(configuration, instrument);
    double brightest = 0;
    for (std::size_t k = 0; k < heights.size(); ++k) {
        const auto image = tracer->expose(heights[k], first_probe_image + static_cast<std::uint32_t>(k));
        brightest = std::max(brightest, brightest_flux(diffraction ? blurred(*diffraction, image.flux) : image.flux,
                                                       image.standard_error));
    }
    if (!(brightest > 0)) {
        throw RunError("No light reaches the camera, which sets its exposure time by it. vkfv image of one position "
                       "without [camera] tells where the light goes; camera.exposure = \"time\" takes images of none");
    }
    const camera::Camera camera(options, configuration.instrument.spectrum);
    const double seconds = camera.time_to(options.saturation, brightest);
    spdlog::info("exposure time {:.4g} ms, by a probe of {} positions and {:.2g} rays each", 1e3 * seconds,
                 heights.size(), static_cast<double>(few_rays.rays));
    return seconds;
}

double exposure_time(const scan::ImageStore& store, const Configuration& configuration,
                     const optics::Instrument& instrument, const specimen::Specimen& specimen,
                     const WorkingDevices& devices) {
    const auto& positions = store.description().positions;
    for (int image = 0; image < static_cast<int>(positions.size()); ++image) {
        if (const auto note = CameraNote::parse(store.note(image))) {
            return note->exposure_time;
        }
    }
    return exposure_time(configuration, instrument, specimen, positions, devices);
}

double brightest_flux(const Grid<double>& flux, const Grid<double>& standard_error) {
    double sum = 0, variance = 0;
    for (std::size_t k = 0; k < flux.values.size(); ++k) {
        sum += flux.values[k];
        variance += standard_error.values[k] * standard_error.values[k];
    }
    const auto pixels = static_cast<double>(flux.values.size());
    const double noise = std::sqrt(variance / pixels) / (sum / pixels); // root mean square over the mean flux
    int side = 1;
    while (2 * side <= std::min(flux.columns, flux.rows) && noise / side > noise_of_squares) {
        side *= 2;
    }
    auto means = means_of_squares(flux, side);
    const auto place = static_cast<std::ptrdiff_t>(outshone_share * static_cast<double>(means.size() - 1));
    std::ranges::nth_element(means, means.begin() + place);
    return means[static_cast<std::size_t>(place)];
}

CameraFigures camera_figures(std::span<const CameraNote> notes) {
    CameraFigures figures;
    const auto count = static_cast<double>(notes.size());
    double camera_variance = 0, ray_variance = 0;
    for (const auto& note : notes) {
        figures.exposure_time = note.exposure_time;
        figures.light.mean += note.light.mean / count;
        figures.light.saturated_share += note.light.saturated_share / count;
        figures.largest_saturated_share = std::max(figures.largest_saturated_share, note.light.saturated_share);
        camera_variance += note.light.camera_noise * note.light.camera_noise / count;
        ray_variance += note.light.ray_noise * note.light.ray_noise / count;
    }
    figures.light.camera_noise = std::sqrt(camera_variance);
    figures.light.ray_noise = std::sqrt(ray_variance);
    return figures;
}

std::optional<CameraFigures> camera_figures(const scan::ImageStore& store) {
    std::vector<CameraNote> notes;
    for (int image = 0; image < static_cast<int>(store.description().positions.size()); ++image) {
        if (const auto note = CameraNote::parse(store.note(image))) {
            notes.push_back(*note);
        }
    }
    return notes.empty() ? std::nullopt : std::optional(camera_figures(notes));
}

nlohmann::ordered_json camera_json(const camera::CameraOptions& options, const CameraFigures& figures) {
    const auto& light = figures.light;
    return {{"values", "grey values in DN"},
            {"exposure_s", figures.exposure_time},
            {"frames", options.frames},
            {"gain_dn_per_e", options.gain},
            {"offset_dn", options.offset},
            {"light_e", light.mean},
            {"camera_noise_e", light.camera_noise},
            {"camera_noise_dn", light.camera_noise * options.gain},
            {"ray_noise_e", light.ray_noise},
            {"ray_noise_dn", light.ray_noise * options.gain},
            {"ray_over_camera_noise", figures.ray_over_camera()},
            {"dsnu_e", options.dark_signal},
            {"prnu_e", options.photo_response * light.mean},
            {"saturated_share", light.saturated_share},
            {"largest_saturated_share", figures.largest_saturated_share},
            {"seed", options.seed}};
}

std::vector<Warning> warnings_of_images(const Configuration& configuration, const CameraFigures& figures) {
    auto warnings = warnings_of(camera::Camera(configuration.camera.value(), configuration.instrument.spectrum));
    std::ranges::copy(camera_warnings(configuration, figures), std::back_inserter(warnings));
    return warnings;
}

std::vector<Warning> camera_warnings(const Configuration& configuration, const CameraFigures& figures) {
    std::vector<Warning> warnings;
    const double ratio = figures.ray_over_camera();
    if (ratio > most_ray_noise) {
        warnings.push_back(
            {.code = "ray-noise-above-camera",
             .key = "trace.rays",
             .value = std::to_string(configuration.trace.rays),
             .works = rays_for_noise(configuration, ratio, most_ray_noise),
             .sentence = fmt::format("The rays' noise, {:.3g} e-, is {:.2g} of the camera's, {:.3g} e-: above a "
                                     "third the images are noisier than "
                                     "the camera's. {}",
                                     figures.light.ray_noise, ratio, figures.light.camera_noise,
                                     remedy_of_noise(configuration, ratio, most_ray_noise))});
    }
    if (figures.largest_saturated_share > most_saturated) {
        const bool by_time = configuration.camera->control == camera::ExposureControl::time;
        warnings.push_back({.code = "saturated",
                            .key = by_time ? "camera.exposure_ms" : "camera.saturation",
                            .value = by_time ? number_text(1e3 * configuration.camera->exposure_time)
                                             : number_text(configuration.camera->saturation),
                            .works = by_time ? "a shorter one" : "a smaller one",
                            .sentence = fmt::format("Up to {:.3g} % of an image's pixels are saturated. {}",
                                                    100 * figures.largest_saturated_share,
                                                    by_time ? "Take a shorter camera.exposure_ms or less source.flux_W"
                                                            : "Take a smaller camera.saturation")});
    }
    return warnings;
}

} // namespace vkfv::measurement
