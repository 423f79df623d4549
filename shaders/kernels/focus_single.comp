#version 460
#extension GL_GOOGLE_include_directive : require
// Follows every pixel's curve of single images by one image, and stores the square of its value.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = BINDING_CURVE, scalar) readonly buffer Curve { float curve[]; };
layout(set = 0, binding = BINDING_SQUARES, scalar) writeonly buffer Squares { float squares[]; };
layout(set = 0, binding = BINDING_SINGLES, scalar) buffer Singles { SingleRecord singles[]; };

layout(push_constant, scalar) uniform Push { SingleImage image; };

void main() {
    uint k = invocation();
    if (k < image.pixels) {
        squares[k] = curve[k] * curve[k];
        singles[k] = follow_single(singles[k], curve[k], image.at);
    }
}
