// How long the stages of the forward trace take on a device.
#pragma once

#include "trace/interface/tracer.hpp"

#include <cstdint>
#include <string>

namespace vkfv::bench {

// Device seconds per launched ray, by device timestamps, for the stages of the forward trace: medians. A stage's time
// is what the trace takes longer with it than ended before it. focal_height: mm.
struct StageTimes {
    std::string description; // device and traversal
    std::uint64_t rays = 0;  // a run
    int runs = 0;
    double seconds_per_ray = 0; // the whole trace
    double spread = 0;          // (maximum - minimum) / median of the whole
    double source = 0;          // shares of the whole
    double illumination = 0;
    double specimen = 0; // meeting it, scatter, gate and occlusion
    double imaging = 0;
    double detection = 0;
    double surfaces_per_ray = 0; // crossings, mean over launched rays, from the ledger
    double surfaces_per_detected_ray = 0;
};
StageTimes time_stages(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                       const trace::TraceOptions& options, double focal_height, int runs);

} // namespace vkfv::bench
