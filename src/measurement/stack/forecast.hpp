// The time, memory and disk space that a stack or an image will take, found by a probe of half a second on the device
// at hand before it is traced.
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
    int devices = 1; // number that work at a time, each as fast as the probe's
    int images = 1;
    std::uint64_t rays_per_image = 0; // launched

    // These figures are of an image with all its rays in the middle of the scan, by the probe.
    double light_per_pixel = 0;          // W, mean
    double detected_rays_per_pixel = 0;  // mean
    double noise = 0;                    // root mean square of the pixels' standard errors over their mean light
    std::optional<CameraFigures> camera; // of the camera's image, by the probe's exposure time
    std::vector<Warning> warnings;
    double seconds_per_image = 0; // wall clock
    double seconds = 0;           // of all images

    // The largest amount in bytes that is taken at a time, and the amount that there is.
    std::uint64_t device_memory = 0;       // without the own memory of the library of Fourier transforms
    std::uint64_t device_memory_there = 0; // 0: the host traces
    std::uint64_t host_memory = 0;         // estimated
    std::uint64_t host_memory_there = 0;
    std::uint64_t disk = 0;
    std::uint64_t disk_there = 0;

    bool fits() const {
        return disk <= disk_there && host_memory <= host_memory_there &&
               (device_memory_there == 0 || device_memory <= device_memory_there);
    }
};

// Traces the probe. Throws InputError, DeviceError, RunError.
Forecast forecast(const Configuration& configuration);

nlohmann::ordered_json json_of(const Forecast& forecast);
// A sentence of a verdict: how long all images take, and on which devices.
std::string time_sentence(const Forecast& forecast);
// Lines for a terminal, without the warnings.
std::string summary(const Forecast& forecast);

} // namespace vkfv::measurement
