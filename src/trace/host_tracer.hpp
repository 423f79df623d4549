// The reference: the same paths in double on the host's cores. Slow, for tests and for machines without Vulkan.
#pragma once

#include "physics/physics.hpp"
#include "trace/tracer.hpp"

#include <memory>
#include <span>

namespace vkfv::trace {

std::unique_ptr<Tracer> make_host_tracer(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                         const TraceOptions& options);

// How one path ended; what the kernel probe_paths gives of the device. x and y (mm) as physics::Detection: 0 for light
// that did not leave the specimen through the gate, and without meaning for light that a surface or the specimen
// stopped.
struct PathEnd {
    std::uint32_t status = 0;
    std::int32_t surface = -1;
    double x = 0;
    double y = 0;
    double weight = 1; // of the light there; with directed scatter of a path's survivor, if it has one
};

// Paths first ... first + count - 1 of one exposure, one by one. source_scale (about 1) scales the
// source's radius and emission: a test asks by it whether a path lies within rounding of an edge.
std::vector<PathEnd> host_paths(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                                const TraceOptions& options, FocalPosition position, std::uint32_t image,
                                std::uint64_t first, std::uint64_t count, double source_scale = 1.0);

// Record of an exposure at the focal height z (mm), for the specimen's record.
physics::f64::Exposure make_exposure(const optics::Instrument& instrument, const physics::f64::SpecimenRecord& specimen,
                                     FocalPosition position, std::uint32_t seed, std::uint32_t image);

} // namespace vkfv::trace
