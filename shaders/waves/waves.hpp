// The C++ side of interface.glsl.
#pragma once

#include <cstdint>

#include "physics/physics.hpp"

#include <glm/glm.hpp>

namespace vkfv::waves {

using glm::uvec2;
using uint = std::uint32_t;
using real = float;
using physics::f32::PupilCells;
#include "waves/interface.glsl"

} // namespace vkfv::waves
