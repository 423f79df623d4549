#version 460
#extension GL_GOOGLE_include_directive : require
// Sorts the light of groups of cells that are mirror images of each other into parts whose mirror images continue them
// evenly or oddly in either direction. Two parts become the real and the imaginary part of one plane (even in both and
// odd in both; odd along rows and odd along columns), in the order in which a Fourier transform of the same length
// becomes their cosine and sine transform (J. Makhoul, IEEE Trans. ASSP-28, 27, 1980): every other value from the
// front, then the rest from the back, with alternating sign for sines.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_PLANES, scalar) writeonly buffer Planes { vec2 planes[]; };
layout(push_constant, scalar) uniform Push { WaveGroups groups; };

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Light { uint64_t light; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer CellAddress { uint64_t first; };

float light_at(uint cell, uint column, uint row) {
    uint64_t image = CellAddress(packUint2x32(groups.light) + uint64_t(8) * uint64_t(cell)).first;
    return float(Light(image + uint64_t(8) * (uint64_t(groups.first_row + row) * groups.image_columns +
                                              groups.first_column + column))
                     .light);
}

// The index, in the transform's order, of the value at the place `from` of a line.
uint destination_of(uint from, uint length) { return from % 2u == 0u ? from / 2u : length - 1u - from / 2u; }

void main() {
    // An invocation takes two neighbours of a row, so that each line of memory is read once.
    uint place = invocation();
    uint pairs = (groups.columns + 1u) / 2u;
    if (place < pairs * groups.rows) {
        uint first_column = place % pairs * 2u;
        uint from_row = place / pairs;
        uint plane = groups.columns * groups.rows;
        uint row = destination_of(from_row, groups.rows) * groups.columns;
        float across = from_row % 2u == 0u ? 1.0 : -1.0;
        for (uint k = 0u; k < groups.count; ++k) {
            uvec4 cells = cells_of_group(groups.first + k, groups.cells_side);
            for (uint from_column = first_column; from_column < min(first_column + 2u, groups.columns); ++from_column) {
                float along = from_column % 2u == 0u ? 0.25 : -0.25;
                float own = light_at(cells.x, from_column, from_row);
                float sideways = light_at(cells.y, from_column, from_row);
                float upright = light_at(cells.z, from_column, from_row);
                float both = light_at(cells.w, from_column, from_row);
                uint to = 2u * k * plane + row + destination_of(from_column, groups.columns);
                planes[to] =
                    vec2(0.25 * (own + sideways + upright + both), along * across * (own - sideways - upright + both));
                planes[to + plane] =
                    vec2(along * (own - sideways + upright - both), 0.25 * across * (own + sideways - upright - both));
            }
        }
    }
}
