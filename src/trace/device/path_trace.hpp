// Base class of the ways of tracing paths on a device, batch by batch, with the buffers of their counts.
#pragma once

#include "trace/device/device_scene.hpp"

#include <cstdint>
#include <vector>

namespace vkfv::trace {

inline constexpr std::uint32_t workgroup_size = 128; // invocations of a workgroup of the forward kernels
inline constexpr std::uint32_t rays_per_invocation = 16;

inline kernels::Batch make_batch(std::uint64_t first, std::uint32_t count) {
    return {{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(first >> 32)}, count};
}

inline constexpr std::uint32_t paths_per_group = workgroup_size * rays_per_invocation;

class PathTrace {
  public:
    PathTrace(const DeviceScene& scene, std::uint32_t batch)
        : scene_(scene), batch_(batch), pixels_(*scene.device, scene.accounts.pixel_numbers() * sizeof(std::uint64_t)),
          fates_(*scene.device, scene.accounts.ledger_numbers() * sizeof(std::uint64_t)) {}
    virtual ~PathTrace() = default;

    void clear(vulkan::Commands& commands) const {
        commands.fill_zero(pixels_);
        commands.fill_zero(fates_);
        commands.barrier();
    }

    // Records the paths first ... first + count - 1 of the exposure. count is at most the batch. timed: with timestamps
    // around and between its stages.
    virtual void record(vulkan::Commands& commands, const ExposureMemory& exposure, std::uint64_t first,
                        std::uint32_t count, bool timed = false) const = 0;

    // The counts: Accounts::pixel_numbers() and ledger_numbers() numbers of 64 bits.
    const vulkan::Buffer& pixels() const { return pixels_; }
    const vulkan::Buffer& fates() const { return fates_; }
    std::uint32_t batch() const { return batch_; }

    // All buffers of counts of an exposure, including the light that is sorted for waves.
    std::vector<const vulkan::Buffer*> counted() const {
        std::vector<const vulkan::Buffer*> buffers = scene_.light_buffers();
        buffers.insert(buffers.end(), {&pixels_, &fates_});
        return buffers;
    }

  protected:
    const DeviceScene& scene_;
    std::uint32_t batch_;
    vulkan::Buffer pixels_;
    vulkan::Buffer fates_;
};

// The number of paths in flight at once, unless the options give it: software devices work best with dispatches of
// about 100 ms, a GPU needs enough rays to fill it.
std::uint32_t suitable_batch(const DeviceScene& scene, const TraceOptions& options);

} // namespace vkfv::trace
