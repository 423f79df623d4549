// What waves make of the light that a device's kernels sort.
#pragma once

#include "optics/waves/pupil_filter.hpp"
#include "trace/device/device_wave_image.hpp"
#include "trace/device/exposure_work.hpp"
#include "trace/device/sorted_light.hpp"
#include "vulkan/buffer.hpp"

#include <future>
#include <memory>

namespace vkfv::trace {

// Who makes something of what a device has counted.
enum class MadeBy { device, host };

// The sorted light in the device's memory; made an image of there, or by the host.
class SceneWaves {
  public:
    // pixels: the detector's. The device must outlive it. Throws RunError where its memory does not hold the light. A
    // thread makes the transforms ready meanwhile; what fails there, require() and make_image() throw.
    SceneWaves(const vulkan::Device& device, optics::PupilFilter filter, ImageSize pixels, MadeBy by);

    ~SceneWaves();
    SceneWaves(const SceneWaves&) = delete;
    SceneWaves& operator=(const SceneWaves&) = delete;

    const optics::PupilFilter& filter() const { return filter_; }
    const SortedLight& sorted_light() const { return light_; } // WaveImage::numbers() of 64 bits
    // Of an image before its first path.
    void clear(vulkan::Commands& commands) const;
    // If not, the host filters what an exposure has sorted, and the next one must wait for that.
    bool on_device() const { return on_device_.valid(); }

    // Throws RunError or DeviceError where it is known by now that the device has no transforms.
    void require() const;
    // On the device: submits what makes light_there() of an exposure's sorted light.
    void make_image(ExposureWork& work) const;
    // Of the pixels, in the units of the sorted light: DeviceWaveImage::bytes() of float.
    const vulkan::Buffer& light_there() const { return on_device_.get()->light_of_pixels(); }
    // By the host, of what is sorted at the moment.
    Grid<double> light_by_host() const;

  private:
    optics::PupilFilter filter_;
    ImageSize pixels_;
    SortedLight light_;
    std::shared_future<std::unique_ptr<const DeviceWaveImage>> on_device_;
    std::future<double> noise_; // the filter's: found while the device traces, kept by what its copies share
};

} // namespace vkfv::trace
