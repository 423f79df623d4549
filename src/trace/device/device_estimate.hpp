// Estimates of each pixel's flux and standard error from counted numbers, made on the device and handed to the host.
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
    // The buffers of an exposure's counts. All of them must outlive the estimate.
    struct Counted {
        const vulkan::Buffer& pixels;            // numbers of the pixels, with `stride` as for estimate_pixels()
        std::size_t stride = 0;                  // in numbers
        const vulkan::Buffer* further = nullptr; // 64-bit numbers that are copied to the host unchanged
        const SceneWaves* waves = nullptr;       // its wave image is the light; null: fluxes are those of rays
        double waves_scale = 0;                  // W for each unit of the wave image
        bool asks_for_power = false;
    };
    struct Estimated {
        PixelLight pixels;
        std::optional<double> power; // W on all pixels, by rays; empty unless asked for
    };

    // Prepares the estimate. A device without doubles leaves it to the host in any case.
    DeviceEstimate(const vulkan::Device& device, const estimate::EstimateRule& rule, ImageSize pixels,
                   const Counted& counted, MadeBy by = MadeBy::device);

    // Allocates the host's memory for a slot, which takes a GPU's driver milliseconds: meant for when the device is at
    // work. Throws RunError where there is none.
    void make_room(std::size_t slot) const;
    // Records the estimate after the last path of an exposure and after its wave image. The host finds the result when
    // the commands have been done, until others are recorded for that slot.
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
    std::optional<vulkan::Kernel> kernel_; // empty: the host makes the estimates
    // The further numbers, then the estimates or the numbers from which the host makes them.
    mutable std::array<std::optional<vulkan::Buffer>, most_exposures> for_host_;
};

} // namespace vkfv::trace
