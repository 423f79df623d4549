// What waves make of the light that a device's scene has sorted.
#pragma once

#include "trace/device_scene.hpp"
#include "trace/device_wave_image.hpp"
#include "trace/exposure_work.hpp"
#include "trace/wave_image.hpp"

#include <cstddef>
#include <optional>

namespace vkfv::trace {

// On the device, or on the host for devices that are the host's cores. The scene, one with a filter, must outlive it.
class SceneWaves {
  public:
    explicit SceneWaves(const DeviceScene& scene);

    // Exposures that may be under way: sorted light that the host filters must not be cleared for the next before.
    std::size_t exposures_at_a_time() const { return on_device_ ? most_exposures : 1; }

    // An exposure's last work. The host finds in bytes_for_host() from to_byte on what light() makes the image of.
    void hand_over(ExposureWork& work, const vulkan::Buffer& for_host, std::size_t to_byte) const;
    std::size_t bytes_for_host() const { return on_device_ ? on_device_->bytes() : 0; }
    // In the units of the sorted light.
    Grid<double> light(const vulkan::Buffer& for_host, std::size_t from_byte) const;

  private:
    const DeviceScene& scene_;
    std::optional<DeviceWaveImage> on_device_;
};

} // namespace vkfv::trace
