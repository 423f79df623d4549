#version 460
#extension GL_GOOGLE_include_directive : require
// The light of each pixel: the sum of its parts, as far as they are sensitive.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_IMAGE, scalar) readonly buffer Image { vec2 image[]; };
layout(set = 0, binding = WAVES_BINDING_PIXELS, scalar) writeonly buffer Pixels { float pixels[]; };
layout(push_constant, scalar) uniform Push { WaveSize size; };

void main() {
    uint place = invocation();
    uint parts = size.cells.parts;
    uint columns = size.columns / parts;
    if (place < columns * (size.rows / parts)) {
        uint column = place % columns * parts;
        uint row = place / columns * parts;
        float sum = 0.0;
        for (uint j = 0u; j < parts; ++j) {
            for (uint i = 0u; i < parts; ++i) {
                sum += sensitive_share(size.cells, i) * sensitive_share(size.cells, j) *
                       image[(row + j) * 2u * size.columns + column + i].x;
            }
        }
        // A cosine stands at four frequencies, and a transform there and back counts 4 columns rows times.
        pixels[place] = sum / (float(size.columns) * float(size.rows));
    }
}
