#version 460
#extension GL_GOOGLE_include_directive : require
// Takes over those pixels that are sharpest in this image.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = BINDING_IMAGE, scalar) readonly buffer Image { float image[]; };
layout(set = 0, binding = BINDING_SHARPEST, scalar) readonly buffer Sharpest { int sharpest[]; };
layout(set = 0, binding = BINDING_ALL_IN_FOCUS, scalar) buffer AllInFocus { float all_in_focus[]; };

layout(push_constant, scalar) uniform Push { SelectedImage selected; };

void main() {
    uint k = invocation();
    if (k < selected.pixels && sharpest[k] == selected.wanted) {
        for (uint channel = 0u; channel < selected.channels; ++channel) {
            all_in_focus[channel * selected.pixels + k] = image[channel * selected.pixels + k];
        }
    }
}
