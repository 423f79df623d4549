// The trace of non-sequential paths, whose order of elements the light itself decides, in one kernel.
#pragma once

#include "trace/device/path_trace.hpp"

namespace vkfv::trace {

kernels::NonsequentialBatch make_nonsequential_batch(const DeviceScene& scene, std::uint64_t first,
                                                     std::uint32_t count);

class NonsequentialTrace final : public PathTrace {
  public:
    NonsequentialTrace(const DeviceScene& scene, std::uint32_t batch);

    void record(vulkan::Commands& commands, const ExposureMemory& exposure, std::uint64_t first, std::uint32_t count,
                bool timed = false) const override;

  private:
    vulkan::Kernel kernel_;
};

} // namespace vkfv::trace
