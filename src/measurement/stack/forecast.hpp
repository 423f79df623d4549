// What a stack or an image will take, before it is traced: from a probe of half a second on the device at hand.
#pragma once

#include "configuration/configuration.hpp"
#include "measurement/image/camera_images.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace vkfv::measurement {

struct Forecast {
    std::string device;
    int devices = 1; // that work at a time, each like the one that was tried
    int images = 1;
    std::uint64_t rays_per_image = 0; // launched

    // By the probe, in the middle of the scan. Of an image with all its rays:
    double light_per_pixel = 0;          // W, mean
    double detected_rays_per_pixel = 0;  // mean
    double noise = 0;                    // root mean square of the pixels' standard errors over their mean light
    std::optional<CameraFigures> camera; // of the camera's image of it; its exposure time is the probe's own
    std::vector<Warning> warnings;
    double seconds_per_image = 0; // wall clock
    double seconds = 0;           // of all images

    // Bytes: at most at a time, and what there is.
    std::uint64_t device_memory = 0;       // without what the library of Fourier transforms keeps for itself
    std::uint64_t device_memory_there = 0; // 0: the host's
    std::uint64_t host_memory = 0;         // estimated
    std::uint64_t host_memory_there = 0;
    std::uint64_t disk = 0;
    std::uint64_t disk_there = 0;

    bool fits() const { return disk <= disk_there && host_memory <= host_memory_there; }
};

// Throws InputError, DeviceError, RunError.
Forecast forecast(const Configuration& configuration);

nlohmann::ordered_json json_of(const Forecast& forecast);
// How long all of it takes, on what, for a verdict.
std::string time_sentence(const Forecast& forecast);
// Lines for a terminal, without the warnings.
std::string summary(const Forecast& forecast);

} // namespace vkfv::measurement
