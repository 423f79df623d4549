#version 460
#extension GL_GOOGLE_include_directive : require
// The light of each pixel: the sum of its parts.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_IMAGE, scalar) readonly buffer Image { vec2 image[]; };
layout(set = 0, binding = WAVES_BINDING_PIXELS, scalar) writeonly buffer Pixels { float pixels[]; };
layout(push_constant, scalar) uniform Push { WaveSize size; };

void main() {
    uint place = invocation();
    uint pixels_side = size.side / size.parts;
    if (place < pixels_side * pixels_side) {
        uint column = place % pixels_side * size.parts;
        uint row = place / pixels_side * size.parts;
        float sum = 0.0;
        for (uint j = 0u; j < size.parts; ++j) {
            for (uint i = 0u; i < size.parts; ++i) {
                sum += image[(row + j) * 2u * size.side + column + i].x;
            }
        }
        // A cosine stands at four frequencies, and a transform there and back counts (2 side)^2 times.
        pixels[place] = sum / (float(size.side) * float(size.side));
    }
}
