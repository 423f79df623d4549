#version 460
#extension GL_GOOGLE_include_directive : require
// Finds the meetings of given rays with the specimen: tests compare them, benchmarks of a traversal time them.
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
