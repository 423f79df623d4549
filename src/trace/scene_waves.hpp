// What waves make of the light that a device's kernels sort.
#pragma once

#include "optics/pupil_filter.hpp"
#include "trace/device_wave_image.hpp"
#include "trace/exposure_work.hpp"
#include "vulkan/buffer.hpp"

#include <cstddef>
#include <future>
#include <memory>

namespace vkfv::trace {

// The sorted light in the device's memory; made an image of there, or by the host for devices that are its cores.
class SceneWaves {
  public:
    // pixels: the detector's. The device must outlive it. Throws RunError where its memory does not hold the light. A
    // thread makes the transforms ready meanwhile; what fails there, require() and hand_over() throw.
    SceneWaves(const vulkan::Device& device, optics::PupilFilter filter, ImageSize pixels);

    ~SceneWaves();
    SceneWaves(const SceneWaves&) = delete;
    SceneWaves& operator=(const SceneWaves&) = delete;

    const optics::PupilFilter& filter() const { return filter_; }
    const vulkan::Buffer& sorted_light() const { return light_; } // WaveImage::numbers() of 64 bits
    // Of an image before its first path.
    void clear(vulkan::Commands& commands) const;
    // If not, the host filters what an exposure has sorted, and the next one must wait for that.
    bool on_device() const { return on_device_.valid(); }

    // Throws RunError or DeviceError where it is known by now that the device has no transforms.
    void require() const;
    // An exposure's last work. The host finds in bytes_for_host() from to_byte on what light() makes the image of.
    void hand_over(ExposureWork& work, const vulkan::Buffer& for_host, std::size_t to_byte) const;
    std::size_t bytes_for_host() const { return on_device() ? DeviceWaveImage::bytes(pixels_) : 0; }
    // In the units of the sorted light.
    Grid<double> light(const vulkan::Buffer& for_host, std::size_t from_byte) const;

  private:
    optics::PupilFilter filter_;
    ImageSize pixels_;
    vulkan::Buffer light_;
    std::shared_future<std::unique_ptr<const DeviceWaveImage>> on_device_;
    std::future<double> noise_; // the filter's: found while the device traces, kept by what its copies share
};

} // namespace vkfv::trace
