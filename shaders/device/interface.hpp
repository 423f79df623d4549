// The C++ side of the records that host and kernels of the trace share besides the physics' own (physics/physics.hpp).
#pragma once

#include "physics/physics.hpp"

#include <cstdint>

#include <glm/glm.hpp>

#define VKFV_DECLARE(type, name) type name;

namespace vkfv::kernels {

using glm::uvec2;
using glm::uvec4;
using uint = std::uint32_t;
using real = physics::f32::real;
using real3 = physics::f32::real3;
using physics::f32::BackwardOptics;
using physics::f32::Exposure;
using physics::f32::Instrument;
using physics::f32::Lattice;
using physics::f32::PupilCells;
using physics::f32::SourceFrame;
using physics::f32::SpecimenRecord;
#include "device/blocks.glsl"
#include "device/numbers.glsl"

struct Parameters {
    VKFV_PARAMETERS_FIELDS(VKFV_DECLARE)
};

} // namespace vkfv::kernels

#undef VKFV_DECLARE
