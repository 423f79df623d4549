// The trace on a Vulkan device, in float: the two halves of the forward path as two kernels.
#pragma once

#include "trace/host_tracer.hpp"
#include "trace/tracer.hpp"

#include <memory>
#include <vector>

namespace vkfv::trace {

// Throws DeviceError (no usable device, too little memory) or InputError (a traversal the specimen or the device
// does not admit).
std::unique_ptr<Tracer> make_device_tracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                           const TraceOptions& options);

// Paths one by one, as host_paths(); for tests. focal_height: mm, as Tracer::expose().
std::vector<PathEnd> device_paths(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                  const TraceOptions& options, double focal_height, std::uint32_t image,
                                  std::uint64_t first, std::uint32_t count);

// Device seconds per launched ray, by device timestamps, for the stages of the forward trace: medians.
// focal_height: mm.
struct StageTimes {
    std::string description;      // device and traversal
    std::uint64_t rays = 0;       // a run
    int runs = 0;
    double seconds_per_ray = 0;   // the whole trace
    double spread = 0;            // (maximum - minimum) / median of the whole
    double lenses = 0;            // shares of the whole
    double specimen = 0;
    double detector = 0;
    double surfaces_per_ray = 0;  // crossings, mean over launched rays, from the ledger
    double surfaces_per_detected_ray = 0;
};
StageTimes time_stages(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                       const TraceOptions& options, double focal_height, int runs);

} // namespace vkfv::trace
