#version 460
#extension GL_GOOGLE_include_directive : require
// Adds the spectra of groups of cells to the image's spectrum, each cell's multiplied by its own transfer function.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_PLANES, scalar) readonly buffer Planes { vec2 planes[]; };
// A node has one complex number for one filter and four for four filters; table_of_four reads the latter in two loads.
layout(set = 0, binding = WAVES_BINDING_TABLE, scalar) readonly buffer Table { vec2 table[]; };
layout(set = 0, binding = WAVES_BINDING_TABLE, scalar) readonly buffer TableOfFour { vec4 table_of_four[]; };
layout(set = 0, binding = WAVES_BINDING_SPECTRUM, scalar) buffer Spectrum { vec4 spectrum[]; };
layout(push_constant, scalar) uniform Push { WaveGroups groups; };
layout(constant_id = WAVES_CONSTANT_FILTERS) const uint filters = 1u;

// The four nodes about a place of a cell's table, x from -steps to steps, y from 0, and their weights: between nodes
// the table is bilinear.
struct Nodes {
    int corner;   // first node: left and low, of the first cell
    vec4 weights; // left and low, right and low, left and above, right and above
};

Nodes nodes_about(float x, float y) {
    float left = floor(x);
    float low = floor(y);
    float u = x - left;
    float v = y - low;
    int columns = 2 * int(groups.steps) + 1;
    return Nodes(int(low) * columns + int(left) + int(groups.steps),
                 vec4((1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v));
}

vec2 transfer(Nodes at, int cell) {
    int low = at.corner + cell;
    int above = low + 2 * int(groups.steps) + 1;
    return at.weights.x * table[low] + at.weights.y * table[low + 1] + at.weights.z * table[above] +
           at.weights.w * table[above + 1];
}

// A window of four filters keeps them in two pairs: this is the transfer function of the filters of one pair.
vec4 transfer_of_two(Nodes at, int cell, uint pair) {
    int low = 2 * (at.corner + cell) + int(pair);
    int above = low + 4 * int(groups.steps) + 2;
    return at.weights.x * table_of_four[low] + at.weights.y * table_of_four[low + 2] +
           at.weights.z * table_of_four[above] + at.weights.w * table_of_four[above + 2];
}

// Adds a cell's spectrum, multiplied by its transfer function, to that of each filter's image: at a frequency (in the
// first two numbers) and at the frequency with the opposite x, which the cell's mirror image has there.
void add(inout vec4 sums[filters], Nodes there, Nodes opposite, uint cell, vec2 light, vec2 light_opposite) {
    int first = int(cell) * (int(groups.steps) + 1) * (2 * int(groups.steps) + 1);
    if (filters == 1u) {
        sums[0] += vec4(times(transfer(there, first), light), times(transfer(opposite, first), light_opposite));
    } else {
        for (uint pair = 0u; pair < filters / 2u; ++pair) {
            vec4 here = transfer_of_two(there, first, pair);
            vec4 mirrored = transfer_of_two(opposite, first, pair);
            sums[2u * pair] += vec4(times(here.xy, light), times(mirrored.xy, light_opposite));
            sums[2u * pair + 1u] += vec4(times(here.zw, light), times(mirrored.zw, light_opposite));
        }
    }
}

// The transforms of the real and the imaginary part of a plane, at a frequency: of two real planes in a complex one
// z(f) + conj z(-f) is twice that of the real part, and (z(f) - conj z(-f)) / i twice that of the imaginary part.
vec4 parted(vec2 z, vec2 opposite) {
    return 0.5 * vec4(z.x + opposite.x, z.y - opposite.y, z.y + opposite.y, opposite.x - z.x);
}

void main() {
    // A workgroup takes 32 frequencies and those that are their mirror images in the transform's order, along columns,
    // rows and both: these four need the same numbers of the planes.
    uint lane = gl_LocalInvocationIndex % 32u;
    uint mirror = gl_LocalInvocationIndex / 32u;
    uint blocks = groups.columns / 2u / 32u + 1u; // blocks of the columns from 0 to the middle
    uint block = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint column = block % blocks * 32u + lane;
    uint row = block / blocks;
    bool doubled = (mirror % 2u == 1u && (column == 0u || 2u * column == groups.columns)) ||
                   (mirror / 2u == 1u && (row == 0u || 2u * row == groups.rows));
    if (2u * column > groups.columns || 2u * row > groups.rows || doubled) {
        return;
    }
    column = mirror % 2u == 0u ? column : groups.columns - column;
    row = mirror / 2u == 0u ? row : groups.rows - row;
    uint plane = groups.columns * groups.rows;
    uint place = row * groups.columns + column;
    vec2 at = vec2(column, row) * vec2(groups.steps_a_column, groups.steps_a_row);
    vec4 sums[filters];
    for (uint k = 0u; k < filters; ++k) {
        sums[k] = groups.first == 0u ? vec4(0.0) : spectrum[k * plane + place];
    }
    if (dot(at, at) < float(groups.steps * groups.steps)) {
        uint left = column == 0u ? 0u : groups.columns - column;
        uint low = row == 0u ? 0u : groups.rows - row;
        // The phase shifts the origin from the first value's middle to the border.
        vec2 turn_column = turned(-0.5 * float(column) / float(groups.columns));
        vec2 turn_row = turned(-0.5 * float(row) / float(groups.rows));
        vec2 both = times(turn_column, turn_row);
        vec2 against = times(turn_column, vec2(turn_row.x, -turn_row.y));
        Nodes there = nodes_about(at.x, at.y);
        Nodes opposite = nodes_about(-at.x, at.y);
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
            add(sums, there, opposite, cells.x, same, sideways);
            add(sums, there, opposite, cells.y, sideways, same);
            add(sums, there, opposite, cells.z, upright, turned_round);
            add(sums, there, opposite, cells.w, turned_round, upright);
        }
    }
    for (uint k = 0u; k < filters; ++k) {
        spectrum[k * plane + place] = sums[k];
    }
}
