// The backward estimator on a device: every pixel's lattice of paths, in one kernel.
#pragma once

#include "trace/device/device_exposures.hpp"
#include "trace/device/device_scene.hpp"
#include "trace/interface/backward_image.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace vkfv::trace {

class BackwardTrace {
  public:
    // scene: of turned_round(instrument).
    BackwardTrace(const DeviceScene& scene, const physics::f64::BackwardOptics& optics, const BackwardPlan& plan,
                  const TraceOptions& options);

    void clear(vulkan::Commands& commands) const;
    // Records the chunks first ... first + count - 1 of a randomisation of the exposure. count is at most
    // most_chunks_at_a_time().
    void record(vulkan::Commands& commands, const ExposureMemory& exposure, std::uint32_t randomisation,
                std::uint64_t first, std::uint32_t count) const;

    // Of 64 bits: of each randomisation the pixels' sums, stride() numbers from one to the next.
    const vulkan::Buffer& sums() const { return sums_; }
    std::size_t stride() const { return stride_; }
    // Of all pixels, of one randomisation.
    std::uint64_t chunks() const { return chunks_; }
    std::uint32_t points_per_chunk() const { return points_per_chunk_; }
    std::uint32_t most_chunks_at_a_time() const { return most_chunks_at_a_time_; }

  private:
    const DeviceScene& scene_;
    std::uint32_t pixels_;
    std::size_t stride_;
    std::uint32_t points_per_chunk_; // of one invocation; the plan's alone, as it decides what floats are added up
    std::uint64_t chunks_;
    std::uint32_t most_chunks_at_a_time_;
    vulkan::Buffer sums_;
    vulkan::Buffer optics_;
    vulkan::Kernel kernel_;
};

// Throws as make_device_tracer().
std::unique_ptr<DeviceExposures> make_backward_tracer(const optics::Instrument& instrument,
                                                      const specimen::Specimen& specimen, const TraceOptions& options);

} // namespace vkfv::trace
