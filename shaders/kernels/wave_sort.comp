#version 460
#extension GL_GOOGLE_include_directive : require
// Of pairs of cells that are mirror images of each other: half the sum of their images, whose mirror images continue it
// evenly, and half the difference, which continues oddly. As the real and the imaginary part of one plane, in the order
// in which a Fourier transform of the same length becomes their cosine and sine transform (J. Makhoul, IEEE Trans.
// ASSP-28, 27, 1980): every other value from the front, then the rest from the back, of sines with the other sign.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_PLANES, scalar) writeonly buffer Planes { vec2 planes[]; };
layout(push_constant, scalar) uniform Push { WavePairs pairs; };

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Light { uint64_t light; };

float light_at(uint cell, uint column, uint row) {
    uint64_t index = (uint64_t(cell) * pairs.side + row) * pairs.side + column;
    return float(Light(packUint2x32(pairs.light) + uint64_t(8) * index).light);
}

// Where the k-th value of a transform comes from.
uint source_of(uint k) {
    uint from_front = (pairs.side + 1u) / 2u;
    return k < from_front ? 2u * k : 2u * (pairs.side - k) - 1u;
}

void main() {
    uint place = invocation();
    uint plane = pairs.side * pairs.side;
    if (place < plane) {
        uint column = place % pairs.side;
        uint row = place / pairs.side;
        uint from_column = source_of(column);
        uint from_row = source_of(row);
        float sign = (from_column % 2u == 0u) == (from_row % 2u == 0u) ? 0.5 : -0.5;
        for (uint k = 0u; k < pairs.count; ++k) {
            uvec2 cells = cells_of_pair(pairs.first + k, pairs.cells_side);
            float own = light_at(cells.x, from_column, from_row);
            float other = light_at(cells.y, from_column, from_row);
            planes[k * plane + place] = vec2(0.5 * (own + other), sign * (own - other));
        }
    }
}
