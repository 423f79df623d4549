// The record of an exposure, by which host and device trace.
#pragma once

#include "physics/physics.hpp"
#include "trace/interface/tracer.hpp"

#include <cstdint>

namespace vkfv::trace {

// The exposure at a focal position (mm) of the specimen with this record; seed and image choose its random numbers.
physics::f64::Exposure make_exposure(const optics::Instrument& instrument, const physics::f64::SpecimenRecord& specimen,
                                     FocalPosition position, std::uint32_t seed, std::uint32_t image);

} // namespace vkfv::trace
