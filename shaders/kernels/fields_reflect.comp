#version 460
#extension GL_GOOGLE_include_directive : require
// The wave that each point of the surface reflects, the mean over its cell: an invocation takes a point of a plane.
#include "fields/device.glsl"

layout(set = 0, binding = FIELDS_BINDING_WAVES, scalar) writeonly buffer Waves { vec2 waves[]; };
layout(push_constant, scalar) uniform Push { FieldBatch of; };

void main() {
    uint points = of.columns * of.rows;
    uint place = invocation();
    if (place < points * of.planes) {
        uint64_t point = uint64_t(4) * uint64_t(place % points);
        float turns = of.first_turns + of.turns * float(of.first + place / points);
        float height = value_at(of.points, point);
        float along = turns * of.pitch * value_at(of.points, point + uint64_t(1));
        float up = turns * of.pitch * value_at(of.points, point + uint64_t(2));
        float amplitude = value_at(of.points, point + uint64_t(3)) * sinc_of(along) * sinc_of(up);
        waves[place] = amplitude * turned(-turns * height);
    }
}
