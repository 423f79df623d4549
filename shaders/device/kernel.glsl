// What every kernel of the trace begins with: the physics, its bindings, the chosen traversal.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#ifdef VKFV_RAY_QUERY
#extension GL_EXT_ray_query : require
#endif
#include "physics/lang.glsl"
#ifdef VKFV_SPECIALISED
#include "device/prescription.glsl"
#endif
#include "physics/all.glsl"
#include "device/bindings.glsl"
#include "device/specimen_hit.glsl"
#ifdef VKFV_NONSEQUENTIAL
layout(push_constant, scalar) uniform Batch {
    uvec2 first_path; // low and high word
    uint count;       // paths of this batch
    uint elements_root;
    SourceFrame source_frame;
};
#include "device/nearest_element.glsl"
#endif
