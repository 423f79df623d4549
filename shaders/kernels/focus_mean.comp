#version 460
#extension GL_GOOGLE_include_directive : require
// A term of a weighted mean of planes.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = BINDING_FROM, scalar) readonly buffer From { float from_values[]; };
layout(set = 0, binding = BINDING_TO, scalar) buffer To { float to_values[]; };

layout(push_constant, scalar) uniform Push { MeanTerm term; };

void main() {
    uint k = invocation();
    if (k < term.count) {
        float value = term.weight * from_values[k];
        to_values[term.first_to + k] = term.first == 1u ? value : to_values[term.first_to + k] + value;
    }
}
