#version 460
#extension GL_GOOGLE_include_directive : require
// Takes over those pixels that are sharpest in this image.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer Image { float image[]; };
layout(set = 0, binding = 1, scalar) readonly buffer Sharpest { int sharpest[]; };
layout(set = 0, binding = 2, scalar) buffer AllInFocus { float all_in_focus[]; };

layout(push_constant, scalar) uniform Choice {
    uint pixels;
    uint channels;
    int wanted;
};

void main() {
    uint k = invocation();
    if (k < pixels && sharpest[k] == wanted) {
        for (uint channel = 0u; channel < channels; ++channel) {
            all_in_focus[channel * pixels + k] = image[channel * pixels + k];
        }
    }
}
