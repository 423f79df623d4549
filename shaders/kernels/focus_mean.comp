#version 460
#extension GL_GOOGLE_include_directive : require
// A term of a weighted mean of planes.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer From { float from_values[]; };
layout(set = 0, binding = 1, scalar) buffer To { float to_values[]; };

layout(push_constant, scalar) uniform Term {
    uint count;
    uint first_to; // where the mean begins
    float weight;
    uint first; // 1: the first term
};

void main() {
    uint k = invocation();
    if (k < count) {
        precise float term = weight * from_values[k]; // rounded as on the host
        to_values[first_to + k] = first == 1u ? term : to_values[first_to + k] + term;
    }
}
