#version 460
#extension GL_GOOGLE_include_directive : require
// Adds to the image's spectrum that of pairs of cells, each cell's by its own transfer function.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_PLANES, scalar) readonly buffer Planes { vec2 planes[]; };
layout(set = 0, binding = WAVES_BINDING_TABLE, scalar) readonly buffer Table { vec2 table[]; };
layout(set = 0, binding = WAVES_BINDING_SPECTRUM, scalar) buffer Spectrum { vec4 spectrum[]; };
layout(push_constant, scalar) uniform Push { WavePairs pairs; };

// Bilinear; x from -steps to steps, y from 0.
vec2 transfer(uint cell, float x, float y) {
    int columns = 2 * int(pairs.steps) + 1;
    float left = floor(x);
    float low = floor(y);
    int corner = (int(cell) * (int(pairs.steps) + 1) + int(low)) * columns + int(left) + int(pairs.steps);
    vec2 below = mix(table[corner], table[corner + 1], x - left);
    vec2 above = mix(table[corner + columns], table[corner + columns + 1], x - left);
    return mix(below, above, y - low);
}

void main() {
    uint place = invocation();
    uint plane = pairs.side * pairs.side;
    if (place >= plane) {
        return;
    }
    uint column = place % pairs.side;
    uint row = place / pairs.side;
    vec2 at = vec2(column, row) * pairs.steps_a_line;
    vec4 sum = pairs.first == 0u ? vec4(0.0) : spectrum[place];
    if (dot(at, at) < float(pairs.steps * pairs.steps)) {
        uint left = column == 0u ? 0u : pairs.side - column;
        uint low = row == 0u ? 0u : pairs.side - row;
        // From the first value's middle to the border.
        vec2 turn_column = turned(-0.5 * float(column) / float(pairs.side));
        vec2 turn_row = turned(-0.5 * float(row) / float(pairs.side));
        vec2 both = times(turn_column, turn_row);
        vec2 against = times(turn_column, vec2(turn_row.x, -turn_row.y));
        for (uint k = 0u; k < pairs.count; ++k) {
            uint first = k * plane;
            vec2 ahead = planes[first + row * pairs.side + column];
            vec2 ahead_opposite = planes[first + low * pairs.side + left];
            vec2 across = planes[first + low * pairs.side + column];
            vec2 across_opposite = planes[first + row * pairs.side + left];
            // Two real planes in a complex one: z(f) + conj z(-f) is twice the transform of the real part, and
            // (z(f) - conj z(-f)) / i of the imaginary part.
            vec2 even_ahead = 0.5 * vec2(ahead.x + ahead_opposite.x, ahead.y - ahead_opposite.y);
            vec2 even_across = 0.5 * vec2(across.x + across_opposite.x, across.y - across_opposite.y);
            vec2 odd_ahead = 0.5 * vec2(ahead.y + ahead_opposite.y, ahead_opposite.x - ahead.x);
            vec2 odd_across = 0.5 * vec2(across.y + across_opposite.y, across_opposite.x - across.x);
            float even = 0.5 * (times(both, even_ahead).x + times(against, even_across).x);
            float odd = 0.5 * (times(against, odd_across).x - times(both, odd_ahead).x);
            uvec2 cells = cells_of_pair(pairs.first + k, pairs.cells_side);
            // The product of two sines changes its sign where one frequency does; mirrored light has it reversed.
            sum.xy += transfer(cells.x, at.x, at.y) * (even - odd) + transfer(cells.y, at.x, at.y) * (even + odd);
            sum.zw += transfer(cells.x, -at.x, at.y) * (even + odd) + transfer(cells.y, -at.x, at.y) * (even - odd);
        }
    }
    spectrum[place] = sum;
}
