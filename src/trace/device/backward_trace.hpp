// The backward estimator on a device: one kernel traces every pixel's lattice of paths.
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
    // scene: made of turned_round(instrument).
    BackwardTrace(const DeviceScene& scene, const physics::f64::BackwardOptics& optics, const BackwardPlan& plan,
                  const TraceOptions& options);

    void clear(vulkan::Commands& commands) const;
    // Records the chunks first ... first + count - 1 of a randomisation of the exposure. count is at most
    // most_chunks_at_a_time().
    void record(vulkan::Commands& commands, const ExposureMemory& exposure, std::uint32_t randomisation,
                std::uint64_t first, std::uint32_t count) const;

    // 64-bit sums of the pixels, randomisation after randomisation, stride() numbers from one to the next.
    const vulkan::Buffer& sums() const { return sums_; }
    std::size_t stride() const { return stride_; }
    // The number of chunks of all pixels in one randomisation.
    std::uint64_t chunks() const { return chunks_; }
    std::uint32_t points_per_chunk() const { return points_per_chunk_; }
    std::uint32_t most_chunks_at_a_time() const { return most_chunks_at_a_time_; }

  private:
    const DeviceScene& scene_;
    std::uint32_t pixels_;
    std::size_t stride_;
    std::uint32_t points_per_chunk_; // depends on the plan alone, as it decides which floats are added up
    std::uint64_t chunks_;
    std::uint32_t most_chunks_at_a_time_;
    vulkan::Buffer sums_;
    vulkan::Buffer optics_;
    vulkan::Kernel kernel_;
};

// Makes the tracer; throws as make_device_tracer() does.
std::unique_ptr<DeviceExposures> make_backward_tracer(const optics::Instrument& instrument,
                                                      const specimen::Specimen& specimen, const TraceOptions& options);

} // namespace vkfv::trace
