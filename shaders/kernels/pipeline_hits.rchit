#version 460
#extension GL_GOOGLE_include_directive : require
// Computes the hit of the primitive that the device has found to be the nearest.
#include "device/kernel.glsl"

layout(location = 0) rayPayloadInEXT Hit met;
hitAttributeEXT vec2 barycentrics; // barycentrics of a triangle; not used for boxes

void main() {
    uint primitive = uint(gl_PrimitiveID);
    if (specimen_kind == SPECIMEN_ANALYTIC) {
        met = hit_of_tile(primitive, gl_WorldRayOriginEXT, gl_WorldRayDirectionEXT);
    } else {
        met = triangle_hit(triangle_vertex(primitive, 0u), triangle_vertex(primitive, 1u),
                           triangle_vertex(primitive, 2u), barycentrics, gl_HitTEXT, gl_WorldRayDirectionEXT);
    }
}
