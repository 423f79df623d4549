#version 460
#extension GL_GOOGLE_include_directive : require
// Adds to the image's spectrum that of groups of cells, each cell's by its own transfer function.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_PLANES, scalar) readonly buffer Planes { vec2 planes[]; };
layout(set = 0, binding = WAVES_BINDING_TABLE, scalar) readonly buffer Table { vec2 table[]; };
layout(set = 0, binding = WAVES_BINDING_SPECTRUM, scalar) buffer Spectrum { vec4 spectrum[]; };
layout(push_constant, scalar) uniform Push { WaveGroups groups; };
layout(constant_id = WAVES_CONSTANT_FILTERS) const uint filters = 1u;

// Bilinear; x from -steps to steps, y from 0.
vec2 transfer(uint tile, uint cell, float x, float y) {
    int columns = 2 * int(groups.steps) + 1;
    float left = floor(x);
    float low = floor(y);
    int place = int(tile * groups.cells_side * groups.cells_side + cell);
    int corner = (place * (int(groups.steps) + 1) + int(low)) * columns + int(left) + int(groups.steps);
    vec2 below = mix(table[corner], table[corner + 1], x - left);
    vec2 above = mix(table[corner + columns], table[corner + columns + 1], x - left);
    return mix(below, above, y - low);
}

// The transforms of the real and the imaginary part of a plane, at a frequency: of two real planes in a complex one
// z(f) + conj z(-f) is twice that of the real part, and (z(f) - conj z(-f)) / i twice that of the imaginary part.
vec4 parted(vec2 z, vec2 opposite) {
    return 0.5 * vec4(z.x + opposite.x, z.y - opposite.y, z.y + opposite.y, opposite.x - z.x);
}

void main() {
    uint place = invocation();
    uint plane = groups.columns * groups.rows;
    if (place >= plane) {
        return;
    }
    uint column = place % groups.columns;
    uint row = place / groups.columns;
    vec2 at = vec2(column, row) * vec2(groups.steps_a_column, groups.steps_a_row);
    vec4 sums[filters];
    for (uint k = 0u; k < filters; ++k) {
        sums[k] = groups.first == 0u ? vec4(0.0) : spectrum[k * plane + place];
    }
    if (dot(at, at) < float(groups.steps * groups.steps)) {
        uint left = column == 0u ? 0u : groups.columns - column;
        uint low = row == 0u ? 0u : groups.rows - row;
        // From the first value's middle to the border.
        vec2 turn_column = turned(-0.5 * float(column) / float(groups.columns));
        vec2 turn_row = turned(-0.5 * float(row) / float(groups.rows));
        vec2 both = times(turn_column, turn_row);
        vec2 against = times(turn_column, vec2(turn_row.x, -turn_row.y));
        for (uint k = 0u; k < groups.count; ++k) {
            vec4 ahead[2];
            vec4 across[2];
            for (uint which = 0u; which < 2u; ++which) {
                uint first = (2u * k + which) * plane;
                ahead[which] =
                    parted(planes[first + row * groups.columns + column], planes[first + low * groups.columns + left]);
                across[which] =
                    parted(planes[first + low * groups.columns + column], planes[first + row * groups.columns + left]);
            }
            // Cosines along rows and columns are real parts of the turned transforms, sines minus the imaginary ones.
            float even = 0.5 * (times(both, ahead[0].xy).x + times(against, across[0].xy).x);
            float odd = 0.5 * (times(against, across[0].zw).x - times(both, ahead[0].zw).x);
            float odd_along = -0.5 * (times(both, ahead[1].xy).y + times(against, across[1].xy).y);
            float odd_across = -0.5 * (times(both, ahead[1].zw).y - times(against, across[1].zw).y);
            // A sine changes its sign where its frequency does; mirrored light has it reversed.
            vec2 same = vec2(even - odd, -odd_along - odd_across);
            vec2 sideways = vec2(even + odd, odd_along - odd_across);
            vec2 upright = vec2(sideways.x, -sideways.y);
            vec2 turned_round = vec2(same.x, -same.y);
            uvec4 cells = cells_of_group(groups.first + k, groups.cells_side);
            for (uint which = 0u; which < filters; ++which) {
                uint tile = groups.tiles[which];
                sums[which].xy += times(transfer(tile, cells.x, at.x, at.y), same) +
                                  times(transfer(tile, cells.y, at.x, at.y), sideways) +
                                  times(transfer(tile, cells.z, at.x, at.y), upright) +
                                  times(transfer(tile, cells.w, at.x, at.y), turned_round);
                sums[which].zw += times(transfer(tile, cells.x, -at.x, at.y), sideways) +
                                  times(transfer(tile, cells.y, -at.x, at.y), same) +
                                  times(transfer(tile, cells.z, -at.x, at.y), turned_round) +
                                  times(transfer(tile, cells.w, -at.x, at.y), upright);
            }
        }
    }
    for (uint k = 0u; k < filters; ++k) {
        spectrum[k * plane + place] = sums[k];
    }
}
