// The times of the stages of the forward trace on a device.
#pragma once

#include "trace/interface/tracer.hpp"

#include <cstdint>
#include <string>

namespace vkfv::bench {

// Median device seconds per launched ray, by device timestamps, for the stages of the forward trace. A stage's time is
// that of the trace ended after it minus that of the trace ended before it. focal_height: mm.
struct StageTimes {
    std::string description; // device and traversal
    std::uint64_t rays = 0;  // rays of a run
    int runs = 0;
    double seconds_per_ray = 0; // the whole trace
    double spread = 0;          // (maximum - minimum) / median of the whole
    double source = 0;          // shares of the whole
    double illumination = 0;
    double specimen = 0; // meeting the specimen, scatter, gate and occlusion
    double imaging = 0;
    double detection = 0;
    double surfaces_per_ray = 0; // mean number of crossings over launched rays, from the ledger
    double surfaces_per_detected_ray = 0;
};
StageTimes time_stages(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                       const trace::TraceOptions& options, double focal_height, int runs);

} // namespace vkfv::bench
