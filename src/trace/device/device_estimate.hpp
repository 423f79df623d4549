// From the numbers that a device has counted to the light of each pixel, made there, and on to the host.
#pragma once

#include "trace/device/device_scene.hpp"
#include "trace/device/scene_waves.hpp"
#include "trace/interface/pixel_estimate.hpp"
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
    // What an exposure counts. All of it must outlive the estimate.
    struct Counted {
        const vulkan::Buffer& pixels;            // with `stride` as estimate_pixels() has them
        std::size_t stride = 0;                  // in numbers
        const vulkan::Buffer* further = nullptr; // numbers of 64 bits that go to the host as they are
        const SceneWaves* waves = nullptr;       // whose image is the light; null: the light as rays bring it
        double waves_scale = 0;                  // W for each unit of theirs
        bool asks_for_power = false;
    };
    struct Estimated {
        PixelLight pixels;
        std::optional<double> power; // W on all pixels, as rays bring it; if it is asked for
    };

    // A device without doubles leaves it to the host in any case.
    DeviceEstimate(const vulkan::Device& device, const estimate::EstimateRule& rule, ImageSize pixels,
                   const Counted& counted, MadeBy by = MadeBy::device);

    // The host's memory for a slot, which takes a GPU's driver milliseconds: meant for when the device is at work.
    // Throws RunError where there is none.
    void make_room(std::size_t slot) const;
    // After the last path of an exposure, and after its waves. The host finds the result when the commands have been
    // done, until others are recorded for that slot.
    void record(vulkan::Commands& commands, std::size_t slot) const;
    Estimated estimated(std::size_t slot) const;
    std::span<const std::uint64_t> further(std::size_t slot) const;

  private:
    bool made_there() const { return kernel_.has_value(); }
    bool has_waves_there() const { return counted_.waves != nullptr && counted_.waves->on_device(); }
    bool has_rays_beside() const { return has_waves_there() && counted_.asks_for_power; }
    std::size_t further_bytes() const { return counted_.further != nullptr ? counted_.further->bytes() : 0; }
    std::size_t plane_byte(std::size_t plane) const {
        return further_bytes() + plane * pixels_.count() * sizeof(double);
    }
    void record_kernel(vulkan::Commands& commands, const vulkan::Buffer& for_host) const;
    void record_copies(vulkan::Commands& commands, const vulkan::Buffer& for_host) const;

    const vulkan::Device& device_;
    estimate::EstimateRule rule_;
    ImageSize pixels_;
    Counted counted_;
    std::optional<vulkan::Kernel> kernel_; // none: the host makes the estimates
    // The further numbers, then the estimates, or what the host makes them of.
    mutable std::array<std::optional<vulkan::Buffer>, most_exposures> for_host_;
};

} // namespace vkfv::trace
