// What waves make of the light that a device's scene has sorted.
#pragma once

#include "trace/device_scene.hpp"
#include "trace/device_wave_image.hpp"
#include "trace/wave_image.hpp"

#include <optional>

namespace vkfv::trace {

// On the device, or on the host for devices that are the host's cores. The scene, one with a filter, must outlive it.
class SceneWaves {
  public:
    explicit SceneWaves(const DeviceScene& scene);

    struct Light {
        Grid<double> pixels; // in the units of the sorted light
        double device_seconds = 0;
    };
    Light light() const;

  private:
    const DeviceScene& scene_;
    std::optional<DeviceWaveImage> on_device_;
};

} // namespace vkfv::trace
