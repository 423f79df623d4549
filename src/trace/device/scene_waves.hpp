// The wave image of the light that a device's kernels sort.
#pragma once

#include "optics/waves/pupil_filter.hpp"
#include "trace/device/device_wave_image.hpp"
#include "trace/device/exposure_work.hpp"
#include "trace/device/sorted_light.hpp"
#include "vulkan/buffer.hpp"

#include <future>
#include <memory>

namespace vkfv::trace {

// Place where counted numbers are evaluated.
enum class MadeBy { device, host };

// The sorted light in the device's memory, and the wave image made of it on the device or by the host.
class SceneWaves {
  public:
    // pixels: the detector's. The device must outlive it. Throws RunError where its memory does not hold the light. A
    // thread prepares the transforms meanwhile; its failures are thrown by require() and make_image().
    SceneWaves(const vulkan::Device& device, optics::PupilFilter filter, ImageSize pixels, MadeBy by);

    ~SceneWaves();
    SceneWaves(const SceneWaves&) = delete;
    SceneWaves& operator=(const SceneWaves&) = delete;

    const optics::PupilFilter& filter() const { return filter_; }
    const SortedLight& sorted_light() const { return light_; } // WaveImage::numbers() of 64 bits
    // Clears the light before an image's first path.
    void clear(vulkan::Commands& commands) const;
    // False: the host filters the sorted light of an exposure, and the next exposure must wait for that.
    bool on_device() const { return on_device_.valid(); }

    // Throws RunError or DeviceError where it is known by now that the device has no transforms.
    void require() const;
    // Submits the making of light_there() from an exposure's sorted light, on the device.
    void make_image(ExposureWork& work) const;
    // The wave image on the device: float for each pixel, in the units of the sorted light; DeviceWaveImage::bytes()
    // long.
    const vulkan::Buffer& light_there() const { return on_device_.get()->light_of_pixels(); }
    // The wave image made by the host from the light sorted at the moment.
    Grid<double> light_by_host() const;

  private:
    optics::PupilFilter filter_;
    ImageSize pixels_;
    SortedLight light_;
    std::shared_future<std::unique_ptr<const DeviceWaveImage>> on_device_;
    std::future<double> noise_; // the filter's noise, computed while the device traces; the filter's copies share it
};

} // namespace vkfv::trace
