#version 460
#extension GL_GOOGLE_include_directive : require
// Rays to meetings with the specimen, one by one: what tests compare and benchmarks of a traversal time.
#include "device/kernel.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = BINDING_GIVEN, scalar) readonly buffer Rays { ProbeRay rays[]; };
layout(set = 0, binding = BINDING_FOUND, scalar) writeonly buffer Hits { Hit hits[]; };

layout(push_constant, scalar) uniform Push { uint count; };

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index < count) {
        ProbeRay ray = rays[index];
        hits[index] = specimen_hit(ray.origin, ray.direction);
    }
}
