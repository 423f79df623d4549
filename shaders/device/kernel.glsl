// Kernels that meet the specimen include this file first: the bindings and the chosen traversal.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#extension GL_EXT_buffer_reference : require
#ifdef VKFV_RAY_QUERY
#extension GL_EXT_ray_query : require
#endif
#ifdef VKFV_RAY_PIPELINE
#extension GL_EXT_ray_tracing : require
#endif
#include "device/bindings.glsl"
#include "device/specimen_hit.glsl"
#ifdef VKFV_NONSEQUENTIAL
layout(push_constant, scalar) uniform Push { NonsequentialBatch batch; };
#include "device/nearest_element.glsl"
#endif
