#include "measurement/stack/forecast.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/progress.hpp"
#include "measurement/evaluation/evaluation.hpp"
#include "measurement/image/exposure.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/disk_space.hpp"
#include "measurement/scene/host_memory.hpp"
#include "measurement/scene/warning_json.hpp"
#include "measurement/scene/working_devices.hpp"
#include "scan/store.hpp"
#include "vulkan/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <span>
#include <string>

namespace vkfv::measurement {

namespace {

constexpr double probe_seconds = 0.5;
constexpr std::uint64_t first_rays = 200'000;
// Bytes that a run holds for each pixel beyond those of the probe: images that wait for the disk, and at the end maps
// of heights, deviations and pictures.
constexpr std::uint64_t bytes_a_pixel_of_run = 450;

// The peak of this process's memory so far, bytes.
std::uint64_t peak_memory() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.starts_with("VmHWM:")) {
            constexpr std::uint64_t bytes_a_kib = 1024;
            return std::stoull(line.substr(line.find_first_of("0123456789"))) * bytes_a_kib;
        }
    }
    return 0;
}

struct Probe {
    trace::Image image;
    std::string device;
    std::uint64_t device_memory = 0, device_memory_there = 0;
};

class Prober {
  public:
    Prober(const Configuration& configuration, double focal_height)
        : configuration_(configuration), focal_height_(focal_height), devices_(configuration.trace.device),
          specimen_(make_specimen(configuration)), instrument_(instrument_for(configuration, specimen_, focal_height)) {
    }

    // The second of two exposures, since the first one warms up.
    Probe expose(std::uint64_t rays) const {
        auto options = configuration_.trace;
        options.rays = std::min(rays, options.rays);
        const auto tracer = devices_.first().make_tracer(instrument_, specimen_, options);
        (void)tracer->expose(focal_height_, 0);
        Probe probe{.image = tracer->expose(focal_height_, 1), .device = tracer->identity().text()};
        if (configuration_.scan) {
            // The memory of an evaluation does not grow with the number of images.
            StackEvaluation evaluation(evaluation_options(configuration_, instrument_),
                                       focus_planes_for(configuration_.evaluate_on, tracer->device()),
                                       diffraction_of_evaluation(configuration_, instrument_), 0);
            const auto positions = configuration_.scan->positions();
            for (std::size_t k = 0; k < std::min<std::size_t>(3, positions.size()); ++k) {
                evaluation.add({scan::as_stored(probe.image.flux)}, positions[k]);
            }
        }
        if (const auto device = tracer->device()) {
            probe.device_memory = device->peak_memory();
            probe.device_memory_there = device->report().memory_bytes;
        }
        return probe;
    }

    int devices() const { return devices_.size(); }

  private:
    const Configuration& configuration_;
    double focal_height_;
    WorkingDevices devices_;
    specimen::Specimen specimen_;
    optics::Instrument instrument_;
};

// The camera's figures of light like the probe's, for `more` times as many rays.
CameraFigures camera_of_probe(const Configuration& configuration, const trace::Image& image, double more) {
    const camera::Camera camera(configuration.camera.value(), configuration.instrument.spectrum);
    const auto& options = camera.options();
    const double seconds = options.control == camera::ExposureControl::time
                               ? options.exposure_time
                               : camera.time_to(options.saturation, brightest_flux(image.flux, image.standard_error));
    CameraNote note{.exposure_time = seconds, .light = camera.light_of(image.flux, image.standard_error, seconds)};
    note.light.ray_noise /= std::sqrt(more);
    return camera_figures(std::span(&note, 1));
}

std::vector<Warning> warnings_of_memory(const Configuration& configuration, const Forecast& found) {
    std::vector<Warning> warnings;
    const ImageSize pixels = configuration.instrument.detector_pixels;
    const auto warn_where = [&](std::uint64_t takes, std::uint64_t there, const std::string& owner) {
        if (there > 0 && takes > there) {
            warnings.push_back({.code = "memory",
                                .key = "detector.pixels",
                                .value = text_of(pixels),
                                .works = pixels_that_fit(pixels, takes, there),
                                .sentence = fmt::format("It takes {} of memory, and {} has {}. Take fewer "
                                                        "detector.pixels.",
                                                        bytes_text(takes), owner, bytes_text(there))});
        }
    };
    warn_where(found.device_memory, found.device_memory_there, found.device);
    warn_where(found.host_memory, found.host_memory_there, "this machine");
    return warnings;
}

} // namespace

Forecast forecast(const Configuration& configuration) {
    const ImageSize pixels = configuration.instrument.detector_pixels;
    const auto positions = configuration.scan ? configuration.scan->positions() : std::vector<double>{0};
    const Prober prober(configuration, positions[positions.size() / 2]);
    const Probe first = prober.expose(first_rays);
    const double first_rate = static_cast<double>(first.image.rays) / first.image.seconds;
    const Probe probe = prober.expose(std::max(2 * first_rays, static_cast<std::uint64_t>(first_rate * probe_seconds)));

    Forecast result;
    result.devices = prober.devices();
    result.images = static_cast<int>(positions.size());
    result.rays_per_image = trace::launched_rays(configuration.trace, configuration.instrument);
    const auto rays = static_cast<double>(result.rays_per_image), tried = static_cast<double>(probe.image.rays);
    const double more = rays / tried;
    const auto count = static_cast<double>(probe.image.flux.values.size());
    for (const double power : probe.image.flux.values) {
        result.light_per_pixel += power / count;
    }
    result.detected_rays_per_pixel = more * static_cast<double>(probe.image.detected) / count;
    result.noise = 1 / signal_to_noise(probe.image) / std::sqrt(more);
    if (configuration.camera && result.light_per_pixel > 0) {
        result.camera = camera_of_probe(configuration, probe.image, more);
        // Only the mean tells whether pixels saturate, since single pixels have the noise of few rays.
        const bool saturated = result.camera->light.mean > configuration.camera->full_well;
        result.camera->light.saturated_share = result.camera->largest_saturated_share = saturated ? 1 : 0;
        result.warnings = camera_warnings(configuration, *result.camera);
    }
    // An image takes a time that does not depend on its rays, and a time in proportion to them. The rays are taken to
    // need at least half of the probe's time, so that a first exposure that other work held up does not make them look
    // free.
    const double between = tried - static_cast<double>(first.image.rays);
    const double slope = between > 0 ? (probe.image.seconds - first.image.seconds) / between : 0;
    const double seconds_a_ray = std::max(slope, probe.image.seconds / tried / 2);
    result.seconds_per_image = probe.image.seconds + (rays - tried) * seconds_a_ray;
    result.seconds = result.seconds_per_image * result.images / result.devices;
    result.device = probe.device;
    result.device_memory = probe.device_memory;
    result.device_memory_there = probe.device_memory_there;
    result.host_memory = peak_memory() + (configuration.scan ? bytes_a_pixel_of_run * pixels.count() : 0);
    result.host_memory_there = memory_of_host();
    append(result.warnings, warnings_of_memory(configuration, result));
    result.disk = static_cast<std::uint64_t>(result.images) * image_bytes(pixels) +
                  (configuration.scan ? results_bytes(configuration) : 0);
    result.disk_there = free_bytes(configuration.output_directory);
    return result;
}

nlohmann::ordered_json json_of(const Forecast& forecast) {
    nlohmann::ordered_json camera;
    if (forecast.camera) {
        camera = {{"exposure_s", forecast.camera->exposure_time},
                  {"light_e", forecast.camera->light.mean},
                  {"camera_noise_e", forecast.camera->light.camera_noise},
                  {"ray_noise_e", forecast.camera->light.ray_noise},
                  {"ray_over_camera_noise", forecast.camera->ray_over_camera()}};
    }
    return {{"device", forecast.device},
            {"devices", forecast.devices},
            {"images", forecast.images},
            {"rays_per_image", forecast.rays_per_image},
            {"light_per_pixel_W", forecast.light_per_pixel},
            {"detected_rays_per_pixel", forecast.detected_rays_per_pixel},
            {"noise", std::isfinite(forecast.noise) ? nlohmann::ordered_json(forecast.noise) : nullptr},
            {"camera", std::move(camera)},
            {"warnings", json_of(forecast.warnings)},
            {"seconds_per_image", forecast.seconds_per_image},
            {"seconds", forecast.seconds},
            {"device_memory_bytes", forecast.device_memory},
            {"device_memory_there_bytes", forecast.device_memory_there},
            {"host_memory_bytes", forecast.host_memory},
            {"host_memory_there_bytes", forecast.host_memory_there},
            {"disk_bytes", forecast.disk},
            {"disk_there_bytes", forecast.disk_there},
            {"fits", forecast.fits()}};
}

std::string time_sentence(const Forecast& forecast) {
    return fmt::format("It takes {} on {}{}: {} images of {:.3g} s, without start and evaluation.",
                       duration_text(forecast.seconds), forecast.device,
                       forecast.devices > 1 ? fmt::format(", {} devices at a time", forecast.devices) : "",
                       forecast.images, forecast.seconds_per_image);
}

std::string summary(const Forecast& forecast) {
    std::string text = fmt::format("forecast, by a probe on {}{}\n", forecast.device,
                                   forecast.devices > 1 ? fmt::format(", {} devices at a time", forecast.devices) : "");
    const auto add = [&](const char* what, const std::string& value) {
        text += fmt::format("  {:<24} {}\n", what, value);
    };
    add("images", fmt::format("{}", forecast.images));
    add("rays an image", fmt::format("{:.4g}", static_cast<double>(forecast.rays_per_image)));
    add("light a pixel", fmt::format("{:.3g} W in the mean, of {:.3g} detected rays", forecast.light_per_pixel,
                                     forecast.detected_rays_per_pixel));
    add("noise", std::isfinite(forecast.noise) ? fmt::format("{:.3g} % of a pixel's mean light", 100 * forecast.noise)
                                               : "no light");
    if (const auto& camera = forecast.camera) {
        add("camera",
            fmt::format("{:.4g} e- a pixel in {:.4g} ms; noise of the camera {:.3g} e-, of the rays {:.3g} e-",
                        camera->light.mean, 1e3 * camera->exposure_time, camera->light.camera_noise,
                        camera->light.ray_noise));
    }
    add("time", fmt::format("{:.3g} s an image, {} in all, without start and evaluation", forecast.seconds_per_image,
                            duration_text(forecast.seconds)));
    if (forecast.device_memory_there > 0) {
        add("memory of the device",
            fmt::format("{} of {}", bytes_text(forecast.device_memory), bytes_text(forecast.device_memory_there)));
    }
    add("memory of the host",
        fmt::format("about {} of {}", bytes_text(forecast.host_memory), bytes_text(forecast.host_memory_there)));
    add("disk", fmt::format("{} of {} that are free", bytes_text(forecast.disk), bytes_text(forecast.disk_there)));
    return text;
}

} // namespace vkfv::measurement
