// The C++ side of the common language (shaders/physics/lang.glsl) for the evaluation of focus stacks: the files of this
// folder as vkfv::focus::f64 (double, the reference) and vkfv::focus::f32 (float, to the device's bits; its callers are
// compiled without contraction).
//
// A scene, handed to the functions that take one, has the members that they use of:
//   real image_value(int channel, int column, int row) const;
//   real window_weight(int distance) const;                         distance 0 ... window_radius
//   WindowSums window_source(int field, int column, int row) const; level and response of a field (window.glsl)
//   WindowSums window_row(int field, int column, int row) const;    result of window_along_row() at this pixel
//   real curve_value(int image) const;
//   real joint_value(int image) const;                              see CurveRecord (records.glsl)
//   real alone_value(int image) const;
#pragma once

#include <cmath>
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
    using glm::floor; \
    using glm::max; \
    using glm::min;
// The types of a namespace, for templates that serve both.
#define VKFV_FOCUS_ARITHMETIC \
    struct Arithmetic { \
        using Real = real; \
        using Plan = FocusPlan; \
        using Sums = WindowSums; \
        using Curve = CurveRecord; \
        using Single = SingleRecord; \
        static real no_place() { return NO_PLACE; } \
        static Curve empty() { return empty_curve(); } \
        static real ratio(real a, real b) { return quotient(a, b); } \
        static real share(real place, int image) { return share_in_focus(place, image); } \
    };

namespace vkfv::focus::f64 {
using real = double;
VKFV_FOCUS_LANGUAGE
inline real quotient(real a, real b) { return a / b; }
inline real root(real a) { return std::sqrt(a); }
inline real natural_log(real a) { return std::log(a); }
inline real exponential(real a) { return std::exp(a); }
#include "focus/all.glsl"
VKFV_FOCUS_ARITHMETIC
} // namespace vkfv::focus::f64

namespace vkfv::focus::f32 {
using real = float;
using uint = std::uint32_t;
VKFV_FOCUS_LANGUAGE
using glm::floatBitsToInt;
using glm::intBitsToFloat;
#include "focus/arithmetic.glsl"

#include "focus/all.glsl"

#include "focus/interface.glsl"
VKFV_FOCUS_ARITHMETIC
} // namespace vkfv::focus::f32

#undef VKFV_FUNCTION
#undef VKFV_SCENE_FUNCTION
#undef VKFV_SCENE_PARAMETER
#undef VKFV_SCENE
#undef VKFV_DECLARE
#undef VKFV_FOCUS_LANGUAGE
#undef VKFV_FOCUS_ARITHMETIC
