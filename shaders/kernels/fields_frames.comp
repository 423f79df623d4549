#version 460
#extension GL_GOOGLE_include_directive : require
// Images at several focal heights: an invocation reads a pixel's fields once for all of them.
#include "fields/device.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Light { float light; };
layout(push_constant, scalar) uniform Push { FieldFrames of; };

void main() {
    uint pixel = invocation();
    if (pixel < of.pixels) {
        float sums[FIELDS_FRAMES];
        for (uint frame = 0u; frame < FIELDS_FRAMES; ++frame) {
            sums[frame] = 0.0;
        }
        for (uint node = 0u; node < of.nodes; ++node) {
            vec2 field = complex_at(of.fields, uint64_t(node) * uint64_t(of.pixels) + uint64_t(pixel));
            for (uint frame = 0u; frame < FIELDS_FRAMES; ++frame) {
                vec2 phase = complex_at(of.phases, uint64_t(node * FIELDS_FRAMES + frame));
                sums[frame] += phase.x * field.x - phase.y * field.y;
            }
        }
        float background = value_at(of.background, uint64_t(pixel));
        for (uint frame = 0u; frame < of.frames; ++frame) {
            Light(of.images + uint64_t(4) * (uint64_t(frame) * uint64_t(of.pixels) + uint64_t(pixel))).light =
                max(0.0, background + of.signal * sums[frame]);
        }
    }
}
