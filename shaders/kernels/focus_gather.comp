#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers the averaged curves' values at one image for a few pixels.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = BINDING_CURVES, scalar) readonly buffer Curves { float curves[]; };
layout(set = 0, binding = BINDING_PIXELS, scalar) readonly buffer Pixels { uint pixels[]; };
layout(set = 0, binding = BINDING_GATHERED, scalar) writeonly buffer Gathered { float gathered[]; };

layout(push_constant, scalar) uniform Push { GatheredImage image; };

void main() {
    uint k = invocation();
    if (k < image.count) {
        gathered[image.first_to + k] = curves[image.first_from + pixels[k]];
    }
}
