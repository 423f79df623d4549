// What waves make of the light that a device's scene has sorted.
#pragma once

#include "trace/device_scene.hpp"
#include "trace/device_wave_image.hpp"
#include "trace/wave_image.hpp"

#include <optional>

namespace vkfv::trace {

// On the device, or on the host for devices that are the host's cores. Scene and filter must outlive it.
class SceneWaves {
  public:
    SceneWaves(const DeviceScene& scene, const optics::PupilFilter& filter);

    struct Light {
        Grid<double> pixels; // in the units of the sorted light
        double device_seconds = 0;
    };
    Light light() const;

  private:
    const DeviceScene& scene_;
    const optics::PupilFilter& filter_;
    std::optional<DeviceWaveImage> on_device_;
};

} // namespace vkfv::trace
