// The C++ side of interface.glsl.
#pragma once

#include <cstdint>

#include "physics/physics.hpp"
#include "waves/tile_ramp.hpp"

#include <glm/glm.hpp>

namespace vkfv::waves {

using glm::uvec2;
using glm::uvec4;
using uint = std::uint32_t;
using real = float;
using f32::TileRamp;
using physics::f32::PupilCells;
#include "waves/interface.glsl"

} // namespace vkfv::waves
