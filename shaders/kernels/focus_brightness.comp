#version 460
#extension GL_GOOGLE_include_directive : require
// Adds an image to the sum from which the stack's brightness is found.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = BINDING_IMAGE, scalar) readonly buffer Latest { float latest[]; };
layout(set = 0, binding = BINDING_BRIGHTNESS, scalar) buffer Brightness { float brightness[]; };

layout(push_constant, scalar) uniform Push { ImageSize size; };

void main() {
    uint k = invocation();
    if (k < size.pixels) {
        float share = quotient(1.0, float(size.channels));
        for (uint channel = 0u; channel < size.channels; ++channel) {
            brightness[k] += latest[channel * size.pixels + k] * share;
        }
    }
}
