// The shared records, rounded from the host's double to the device's float.
#pragma once

#include "optics/instrument.hpp"
#include "physics/physics.hpp"

#include <vector>

namespace vkfv::trace {

// The uniform block of shaders/device/bindings.glsl.
struct Parameters {
    physics::f32::Instrument instrument;
    physics::f32::SpecimenRecord specimen;
    physics::f32::Exposure exposure;
};

// The other one: every surface, padded to the block's capacity. Throws InputError when there are more.
std::vector<physics::f32::Surface> surface_block(const optics::Instrument& instrument);

// The spectrum's, padded likewise.
std::vector<physics::f32::SpectralBin> spectrum_block(const optics::Instrument& instrument);

physics::f32::Surface to_float(const physics::f64::Surface& surface);
physics::f32::Element to_float(const physics::f64::Element& element);
physics::f32::SourceFrame to_float(const physics::f64::SourceFrame& frame);
physics::f32::Instrument to_float(const physics::f64::Instrument& instrument);
physics::f32::Exposure to_float(const physics::f64::Exposure& exposure);

} // namespace vkfv::trace
