// The forward trace in two kernels: from the source over the specimen to the pupil's gate, and from there to the
// detector.
#pragma once

#include "trace/device/path_trace.hpp"

namespace vkfv::trace {

class ForwardTrace final : public PathTrace {
  public:
    // stop_illumination, stop_imaging: stages after which the kernels end early, for timing alone.
    ForwardTrace(const DeviceScene& scene, std::uint32_t batch, std::uint32_t stop_illumination = kernels::STOP_NOWHERE,
                 std::uint32_t stop_imaging = kernels::STOP_NOWHERE);

    void record(vulkan::Commands& commands, const ExposureMemory& exposure, std::uint64_t first, std::uint32_t count,
                bool timed = false) const override;

  private:
    vulkan::Buffer survivors_;
    vulkan::Buffer survivor_count_;
    vulkan::Kernel illumination_;
    vulkan::Kernel imaging_;
};

} // namespace vkfv::trace
