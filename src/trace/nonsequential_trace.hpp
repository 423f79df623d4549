// Non-sequential paths: light finds its own way through the elements, in one kernel.
#pragma once

#include "trace/path_trace.hpp"

namespace vkfv::trace {

// Push constants of the non-sequential kernels.
struct NonsequentialBatch {
    Batch paths;
    std::uint32_t elements_root;
    physics::f32::SourceFrame source_frame;
};
static_assert(sizeof(NonsequentialBatch) == 16 * 4);

NonsequentialBatch make_nonsequential_batch(const DeviceScene& scene, std::uint64_t first, std::uint32_t count);

class NonsequentialTrace final : public PathTrace {
  public:
    NonsequentialTrace(const DeviceScene& scene, std::uint32_t batch);

    void record(vulkan::Commands& commands, std::uint64_t first, std::uint32_t count,
                bool timed = false) const override;

  private:
    vulkan::Kernel kernel_;
};

} // namespace vkfv::trace
