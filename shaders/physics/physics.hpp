// The C++ side of the common language (see lang.glsl): everything in this folder as vkfv::physics::f64 (double,
// the reference) and vkfv::physics::f32 (float, the device's arithmetic on the host).
//
// A scene, handed to the functions that take one, has these members:
//   Surface surface_at(int index) const;
//   EmissionCell emission_cell(uvec2 path) const;      only for forward paths
//   uint features() const;                             FEATURE_* of its trains
//   SpectralBin spectral_bin(int index) const;         only with FEATURE_SPECTRUM
//   Hit specimen_hit(real3 origin, real3 direction) const;
//   real pattern_point(Pattern pattern, int column, int row) const;   only of patterns with a grid
//   LightField light_field() const;                    only with FEATURE_LIGHT_FIELD
//   Element element_at(int index) const;              only for non-sequential paths
//   ElementHit nearest_element(real3 origin, real3 direction, PathPlace from) const;   only for non-sequential paths
//   Facet facet_at(int index) const;                  only with FEATURE_FACETS
//   real lattice_at(int column, int row) const;      only for analytic specimens with a lattice
//   real material_number(int index) const;            only of materials that have numbers
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/glm.hpp>
#include <glm/integer.hpp>

#define VKFV_FUNCTION inline
#define VKFV_PRECISE
#define VKFV_SCENE_FUNCTION template <class Scene>
#define VKFV_SCENE_PARAMETER const Scene &scene,
#define VKFV_SCENE scene,
#define VKFV_SCENE_ALONE scene
#define VKFV_LEAVE_IF(condition)
#define VKFV_DECLARE(type, name) type name;
#define VKFV_DECLARE_ARRAY(type, name, size) type name[size];
#define VKFV_DECLARE_KNOWN(k, place, type, name) type name;

#define VKFV_PHYSICS_LANGUAGE \
    using glm::abs; \
    using glm::atan; \
    using glm::ceil; \
    using glm::clamp; \
    using glm::cos; \
    using glm::dot; \
    using glm::exp; \
    using glm::floor; \
    using glm::fract; \
    using glm::inversesqrt; \
    using glm::isinf; \
    using glm::isnan; \
    using glm::log; \
    using glm::max; \
    using glm::min; \
    using glm::mix; \
    using glm::pow; \
    using glm::sin; \
    using glm::sqrt; \
    using glm::uvec2; \
    using glm::uvec4; \
    using uint = std::uint32_t; \
    inline real3 fma(real3 a, real3 b, real3 c) { return a * b + c; } \
    inline uint multiply_high(uint a, uint b) { return static_cast<uint>((static_cast<std::uint64_t>(a) * b) >> 32); }

namespace vkfv::physics::f64 {
using real = double;
using real2 = glm::dvec2;
using real3 = glm::dvec3;
VKFV_PHYSICS_LANGUAGE
#include "physics/all.glsl"
} // namespace vkfv::physics::f64

namespace vkfv::physics::f32 {
using real = float;
using real2 = glm::vec2;
using real3 = glm::vec3;
VKFV_PHYSICS_LANGUAGE
#include "physics/all.glsl"
} // namespace vkfv::physics::f32

#undef VKFV_FUNCTION
#undef VKFV_PRECISE
#undef VKFV_SCENE_FUNCTION
#undef VKFV_SCENE_PARAMETER
#undef VKFV_SCENE
#undef VKFV_SCENE_ALONE
#undef VKFV_LEAVE_IF
#undef VKFV_DECLARE
#undef VKFV_DECLARE_ARRAY
#undef VKFV_DECLARE_KNOWN
#undef VKFV_PHYSICS_LANGUAGE
