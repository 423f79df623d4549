#version 460
#extension GL_GOOGLE_include_directive : require
// The mean of a field over each pixel, with the tilt of the reference mirror: an invocation takes a pixel of a plane.
#include "fields/device.glsl"

layout(set = 0, binding = FIELDS_BINDING_WAVES, scalar) readonly buffer Waves { vec2 waves[]; };
layout(push_constant, scalar) uniform Push { FieldBatch of; };

void main() {
    uint pixels = of.pixel_columns * of.pixel_rows;
    uint place = invocation();
    if (place < pixels * of.planes) {
        uint plane = place / pixels;
        uint column = of.margin_x + place % of.pixel_columns * of.parts;
        uint row = of.margin_y + place % pixels / of.pixel_columns * of.parts;
        float turns = of.first_turns + of.turns * float(of.first + plane);
        vec2 sum = vec2(0.0);
        for (uint j = 0u; j < of.parts; ++j) {
            for (uint i = 0u; i < of.parts; ++i) {
                float rise = of.pitch * (of.tilt_x * (float(column + i) - of.centre_x) +
                                         of.tilt_y * (float(row + j) - of.centre_y));
                sum += product(waves[(plane * of.rows + row + j) * of.columns + column + i], turned(turns * rise));
            }
        }
        Complex(of.pixels + uint64_t(8) * (uint64_t(of.first) * uint64_t(pixels) + uint64_t(place))).number =
            sum / float(of.parts * of.parts);
    }
}
