#version 460
#extension GL_GOOGLE_include_directive : require
// The spectrum of the image with its mirror images, as seen from the middle of the first part.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_SPECTRUM, scalar) readonly buffer Spectrum { vec4 spectrum[]; };
layout(set = 0, binding = WAVES_BINDING_IMAGE, scalar) writeonly buffer Image { vec2 image[]; };
layout(push_constant, scalar) uniform Push { WaveSize size; };
layout(constant_id = WAVES_CONSTANT_FILTERS) const uint filters = 1u;

void main() {
    uint period = 2u * size.columns;
    uint half_plane = size.rows * period;
    uint which = invocation() / half_plane; // filter
    uint place = invocation() % half_plane;
    if (which < filters) {
        uint column = place % period;
        uint row = place / period; // the lower half; the rest are the conjugates of the opposite frequencies
        uint first = 2u * half_plane * which;
        uint nearest = column < size.columns ? column : period - column;
        vec2 value = vec2(0.0);
        if (nearest < size.columns) {
            vec4 both = spectrum[(which * size.rows + row) * size.columns + nearest];
            bool behind = column > size.columns;
            float along = float(nearest) / float(period);
            float across = float(row) / float(2u * size.rows);
            float half_turns = behind ? across - along : across + along;
            value = times(turned(half_turns), behind ? both.zw : both.xy);
        }
        image[first + row * period + column] = value;
        if (row > 0u) {
            uint opposite = column == 0u ? 0u : period - column;
            image[first + (2u * size.rows - row) * period + opposite] = vec2(value.x, -value.y);
        } else {
            image[first + size.rows * period + column] = vec2(0.0); // the frequency of a half, which no pupil passes
        }
    }
}
