// How fast a device meets rays with a specimen: the traversal alone, without lenses.
#pragma once

#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"

#include <cstdint>
#include <string>

namespace vkfv::bench {

enum class HitOrder {
    random, // points anywhere on the top plane, uniform over the pupil
    morton, // the same, but each 32 rays in one stratum, strata along a Morton curve
    leaving // Lambertian light that leaves random points of the surface: most of it meets nothing
};

struct HitTimes {
    std::string description;    // device and traversal
    std::uint64_t rays = 0;     // a run
    double hits_per_second = 0; // rays tested per device second, the making of each included: median of the runs
    double spread = 0;          // (maximum - minimum) / median
    double share_met = 0;       // of the rays
};

// options: device, traversal, seed; batch: rays a run, 0: what suits the device. numerical_aperture: sine of the
// cone's half-angle about -z, below 1; without meaning for rays that leave. Throws as make_device_tracer().
HitTimes time_hits(const specimen::Specimen& specimen, const trace::TraceOptions& options, double numerical_aperture,
                   HitOrder order, int runs);

} // namespace vkfv::bench
