// The shared records, rounded from the host's double to the device's float.
#pragma once

#include "physics/physics.hpp"

namespace vkfv::trace {

// The uniform block of shaders/device/bindings.glsl.
struct Parameters {
    physics::f32::Instrument instrument;
    physics::f32::SpecimenRecord specimen;
    physics::f32::Exposure exposure;
};

physics::f32::Surface to_float(const physics::f64::Surface& surface);
physics::f32::Instrument to_float(const physics::f64::Instrument& instrument);
physics::f32::Exposure to_float(const physics::f64::Exposure& exposure);

} // namespace vkfv::trace
