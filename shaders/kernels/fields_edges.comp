#version 460
#extension GL_GOOGLE_include_directive : require
// The wave of the cells that hold an edge, the mean over their parts: an invocation takes an edge in a plane.
#include "fields/device.glsl"

layout(set = 0, binding = FIELDS_BINDING_WAVES, scalar) writeonly buffer Waves { vec2 waves[]; };
layout(push_constant, scalar) uniform Push { FieldBatch of; };

void main() {
    uint place = invocation();
    if (place < of.edge_count * of.planes) {
        uint edge = place % of.edge_count;
        float turns = of.first_turns + of.turns * float(of.first + place / of.edge_count);
        vec2 sum = vec2(0.0);
        for (uint part = 0u; part < FIELDS_EDGE_PARTS; ++part) {
            sum += turned(-turns * value_at(of.heights, uint64_t(edge) * uint64_t(FIELDS_EDGE_PARTS) + uint64_t(part)));
        }
        uint point = Index(of.edges + uint64_t(4) * uint64_t(edge)).index;
        float amplitude = value_at(of.points, uint64_t(4) * uint64_t(point) + uint64_t(3));
        waves[place / of.edge_count * of.columns * of.rows + point] = amplitude / float(FIELDS_EDGE_PARTS) * sum;
    }
}
