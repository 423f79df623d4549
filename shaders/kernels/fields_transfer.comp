#version 460
#extension GL_GOOGLE_include_directive : require
// The interferometer's transfer function: an invocation takes a frequency of a plane.
#include "fields/device.glsl"

layout(set = 0, binding = FIELDS_BINDING_WAVES, scalar) buffer Waves { vec2 waves[]; };
layout(push_constant, scalar) uniform Push { FieldBatch of; };

float frequency(uint place, uint count) { return float(2u * place < count ? int(place) : int(place) - int(count)); }

void main() {
    uint points = of.columns * of.rows;
    uint place = invocation();
    if (place < points * of.planes) {
        float x = frequency(place % of.columns, of.columns);
        float y = frequency(place % points / of.columns, of.rows);
        float step = length(vec2(x * of.steps_a_column, y * of.steps_a_row));
        vec2 factor = vec2(0.0);
        if (step < float(of.steps)) {
            uint below = uint(step);
            uint64_t at = uint64_t(below) * uint64_t(of.nodes) + uint64_t(of.first + place / points);
            factor = mix(complex_at(of.transfer, at), complex_at(of.transfer, at + uint64_t(of.nodes)),
                         step - float(below)) /
                     float(points);
        }
        waves[place] = product(waves[place], factor);
    }
}
