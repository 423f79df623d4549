// From the numbers that a device has counted to the light of each pixel, made there, and on to the host.
#pragma once

#include "trace/device_scene.hpp"
#include "trace/pixel_estimate.hpp"
#include "trace/scene_waves.hpp"
#include "vulkan/buffer.hpp"
#include "vulkan/kernel.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace vkfv::trace {

class DeviceEstimate {
  public:
    enum class By { device, host }; // a device without doubles leaves it to the host
    struct Counted {
        const vulkan::Buffer& pixels;            // with `stride` as estimate_pixels() has them
        std::size_t stride = 0;                  // in numbers
        const vulkan::Buffer* further = nullptr; // numbers of 64 bits that go to the host as they are
    };
    // waves: whose image is the light, in waves_scale W a unit; null: none. All must outlive it.
    DeviceEstimate(const vulkan::Device& device, const estimate::EstimateRule& rule, ImageSize pixels,
                   const Counted& counted, const SceneWaves* waves, double waves_scale, By by = By::device);

    // After the last path of an exposure, and after its waves. The host finds the result when the commands have been
    // done, until others are recorded for that slot.
    void record(vulkan::Commands& commands, std::size_t slot) const;
    PixelLight light(std::size_t slot) const;
    double power(std::size_t slot) const; // W on all pixels, as rays bring it
    std::span<const std::uint64_t> further(std::size_t slot) const;

  private:
    bool has_waves_there() const { return waves_ != nullptr && waves_->on_device(); }
    std::size_t plane_bytes() const { return pixels_.count() * sizeof(double); }
    std::size_t further_bytes() const { return counted_.further != nullptr ? counted_.further->bytes() : 0; }
    void record_estimates(vulkan::Commands& commands, const vulkan::Buffer& for_host) const;
    void record_numbers(vulkan::Commands& commands, const vulkan::Buffer& for_host) const;
    PixelLight by_rays(const vulkan::Buffer& for_host) const;

    const vulkan::Device& device_;
    estimate::EstimateRule rule_;
    ImageSize pixels_;
    Counted counted_;
    const SceneWaves* waves_;
    double waves_scale_;
    // None: the host makes them.
    std::optional<vulkan::Buffer> estimates_;
    std::optional<vulkan::Kernel> kernel_;
    // The further numbers, then the estimates, or what they are made of. Made while the device traces.
    mutable std::array<std::optional<vulkan::Buffer>, most_exposures> for_host_;
};

} // namespace vkfv::trace
