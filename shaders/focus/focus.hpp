// The C++ side of the common language (shaders/physics/lang.glsl) for the evaluation of focus stacks: the files of this
// folder as vkfv::focus::f64 (double, the reference) and vkfv::focus::f32 (float, the device's arithmetic on the host).
//
// A scene, handed to the functions that take one, has what they need of:
//   real image_value(int channel, int column, int row) const;
//   real window_weight(int distance) const;                         distance 0 ... window_radius
//   WindowSums window_source(int field, int column, int row) const; level and response of a field (window.glsl)
//   WindowSums window_row(int field, int column, int row) const;    what window_along_row() gave there
//   real curve_value(int image) const;
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#define VKFV_FUNCTION inline
#define VKFV_SCENE_FUNCTION template <class Scene>
#define VKFV_SCENE_PARAMETER const Scene &scene,
#define VKFV_SCENE scene,
#define VKFV_DECLARE(type, name) type name;
#define VKFV_FOCUS_LANGUAGE \
    using glm::abs; \
    using glm::clamp; \
    using glm::exp; \
    using glm::floor; \
    using glm::log; \
    using glm::max; \
    using glm::min; \
    using glm::sqrt;

namespace vkfv::focus::f64 {
using real = double;
VKFV_FOCUS_LANGUAGE
#include "focus/all.glsl"
} // namespace vkfv::focus::f64

namespace vkfv::focus::f32 {
using real = float;
using uint = std::uint32_t;
VKFV_FOCUS_LANGUAGE
#include "focus/all.glsl"

#include "focus/interface.glsl"
} // namespace vkfv::focus::f32

#undef VKFV_FUNCTION
#undef VKFV_SCENE_FUNCTION
#undef VKFV_SCENE_PARAMETER
#undef VKFV_SCENE
#undef VKFV_DECLARE
#undef VKFV_FOCUS_LANGUAGE
