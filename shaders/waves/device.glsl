// The kernels of the wave image include this file first. An invocation takes a place; workgroups stand in rows where
// one row holds too few.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_buffer_reference : require
#include "physics/lang.glsl"
#include "physics/pupil_cells.glsl"
#include "waves/tile_ramp.glsl"
#include "waves/interface.glsl"

uint invocation() {
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
}

vec2 times(vec2 a, vec2 b) { return vec2(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x); }

vec2 turned(float half_turns) {
    float angle = 3.14159265358979324 * half_turns;
    return vec2(cos(angle), sin(angle));
}

// Four cells that are mirror images of each other: the k-th cell of the lower left quarter, and its images left to
// right, upside down, and both.
uvec4 cells_of_group(uint group, uint side) {
    uint row = group / (side / 2u);
    uint column = group % (side / 2u);
    uint other_row = side - 1u - row;
    uint other_column = side - 1u - column;
    return uvec4(row * side + column, row * side + other_column, other_row * side + column,
                 other_row * side + other_column);
}
