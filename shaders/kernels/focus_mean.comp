#version 460
#extension GL_GOOGLE_include_directive : require
// Adds the terms of a weighted mean of planes one after the other.
layout(local_size_x = 128) in;

#include "focus/device.glsl"
#include "focus/planes.glsl"

layout(set = 0, binding = BINDING_TO, scalar) buffer To { float to_values[]; };

layout(push_constant, scalar) uniform Push { MeanTerms terms; };

void main() {
    uint k = invocation();
    if (k < terms.count) {
        int plane = 0;
        float sum = 0;
        if (terms.first == 1u) {
            sum = terms.weights[0] * plane_value(0, k);
            plane = 1;
        } else {
            sum = to_values[terms.first_to + k];
        }
        for (; plane < terms.planes; ++plane) {
            float value = terms.weights[plane] * plane_value(plane, k);
            sum = sum + value;
        }
        to_values[terms.first_to + k] = sum;
    }
}
