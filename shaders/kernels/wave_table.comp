#version 460
#extension GL_GOOGLE_include_directive : require
// Puts the transfer functions of the four filters of a window side by side: all are looked up at the same nodes, and
// one place in memory then serves the four.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_TABLES, scalar) readonly buffer Tables { vec2 tables[]; };
layout(set = 0, binding = WAVES_BINDING_TABLE, scalar) writeonly buffer Table { vec2 table[]; };
layout(push_constant, scalar) uniform Push { WaveTables window; };

void main() {
    uint place = invocation();
    if (place < 4u * window.nodes) {
        table[place] = tables[window.tiles[place % 4u] * window.nodes + place / 4u];
    }
}
