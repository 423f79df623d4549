// Traces given rays through a train, for comparison with other programs.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "physics/physics.hpp"
#include "trace/interface/tracer.hpp"

#include <span>
#include <string>
#include <vector>

namespace vkfv::trace {

// A ray at the specimen, in the specimen frame with its origin in the paraxial object plane; mm and direction cosines.
struct RayInput {
    double x = 0, y = 0, z = 0;
    double l = 0, m = 0, n = 1;
};

// A traced ray on the detector's plane, mm, axes parallel to the specimen's, inversion not removed. path_length:
// optical path from the given point, mm. status: "ok", "vignetted", "missed" or "tir"; coordinates are NaN unless the
// ray arrived. surface: index among all surfaces of the instrument at which it ended, else -1.
struct TracedRay {
    double x = 0, y = 0;
    double l = 0, m = 0, n = 0;
    double path_length = 0;
    std::string status;
    int surface = -1;
};

std::vector<TracedRay> trace_rays_on_host(const optics::Instrument& instrument, std::span<const RayInput> rays,
                                          bool apertures);

// Traces the rays in float on a device; `device` as TraceOptions::device. Throws DeviceError.
std::vector<TracedRay> trace_rays_on_device(const optics::Instrument& instrument, std::span<const RayInput> rays,
                                            bool apertures, const std::string& device);

// Trace rays given in the frame of a train's first vertex, directions scaled by the index. Rays of the illumination end
// on the plane of best focus, in the frame of its last vertex. form: SHORT_TRAIN_* (shaders/physics/short_train.glsl),
// always with apertures and without path lengths; 0: the long form.
std::vector<TracedRay> trace_train_on_host(const optics::Instrument& instrument, Train train,
                                           std::span<const physics::f64::Ray> rays, bool apertures);
std::vector<TracedRay> trace_train_on_device(const optics::Instrument& instrument, Train train,
                                             std::span<const physics::f64::Ray> rays, bool apertures,
                                             const std::string& device, std::uint32_t form = 0);

} // namespace vkfv::trace
