// The speed at which a device finds the hits of rays with a specimen: the traversal alone, without lenses.
#pragma once

#include "specimen/specimen.hpp"
#include "trace/interface/tracer.hpp"

#include <cstdint>
#include <string>

namespace vkfv::bench {

enum class HitOrder {
    random, // points anywhere on the top plane, uniform over the pupil
    morton, // as random, but each 32 rays in one stratum, strata along a Morton curve
    leaving // Lambertian light that leaves random points of the surface; most rays meet nothing
};

struct HitTimes {
    std::string description;    // device and traversal
    std::uint64_t rays = 0;     // rays of a run
    double hits_per_second = 0; // rays tested per device second, including the making of each: median of the runs
    double spread = 0;          // (maximum - minimum) / median
    double share_met = 0;       // share of the rays that met the specimen
};

// Times the hits of rays in one order. options: device, traversal, seed; batch: rays of a run, 0: a number that suits
// the device. numerical_aperture: sine of the cone's half-angle about -z, below 1; not used for rays that leave. Throws
// as make_device_tracer().
HitTimes time_hits(const specimen::Specimen& specimen, const trace::TraceOptions& options, double numerical_aperture,
                   HitOrder order, int runs);

} // namespace vkfv::bench
