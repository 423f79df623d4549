// The C++ side of tile_ramp.glsl: in double for the host, in float for device buffers.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#define VKFV_FUNCTION inline
#define VKFV_DECLARE(type, name) type name;

namespace vkfv::waves {

namespace f64 {
using glm::clamp;
using uint = std::uint32_t;
using real = double;
using real2 = glm::dvec2;
#include "waves/tile_ramp.glsl"
} // namespace f64

namespace f32 {
using glm::clamp;
using uint = std::uint32_t;
using real = float;
using real2 = glm::vec2;
#include "waves/tile_ramp.glsl"
} // namespace f32

} // namespace vkfv::waves

#undef VKFV_FUNCTION
#undef VKFV_DECLARE
