#version 460
#extension GL_GOOGLE_include_directive : require
// Makes the spectra of the filters' images continued by their mirror images, with the phase of the middle of the first
// part. The images are real, so two of four become the real and the imaginary part of one plane.
layout(local_size_x = 128) in;

#include "waves/device.glsl"

layout(set = 0, binding = WAVES_BINDING_SPECTRUM, scalar) readonly buffer Spectrum { vec4 spectrum[]; };
layout(set = 0, binding = WAVES_BINDING_IMAGE, scalar) writeonly buffer Image { vec2 image[]; };
layout(push_constant, scalar) uniform Push { WaveSize size; };
layout(constant_id = WAVES_CONSTANT_FILTERS) const uint filters = 1u;

const uint planes = filters == 1u ? 1u : filters / 2u;

void main() {
    uint period = 2u * size.columns;
    uint half_plane = size.rows * period;
    uint which = invocation() / half_plane; // index of the plane
    uint place = invocation() % half_plane;
    if (which < planes) {
        uint column = place % period;
        uint row = place / period; // only the lower half; the rest are the conjugates of the opposite frequencies
        uint first = 2u * half_plane * which;
        uint nearest = column < size.columns ? column : period - column;
        vec2 real_part = vec2(0.0);
        vec2 imaginary_part = vec2(0.0);
        if (nearest < size.columns) {
            bool behind = column > size.columns;
            float along = float(nearest) / float(period);
            float across = float(row) / float(2u * size.rows);
            vec2 turn = turned(behind ? across - along : across + along);
            uint from = row * size.columns + nearest;
            uint of_filter = size.rows * size.columns;
            vec4 both = spectrum[2u * which * of_filter + from];
            real_part = times(turn, behind ? both.zw : both.xy);
            if (filters > 1u) {
                both = spectrum[(2u * which + 1u) * of_filter + from];
                imaginary_part = times(turn, behind ? both.zw : both.xy);
            }
        }
        image[first + row * period + column] = vec2(real_part.x - imaginary_part.y, real_part.y + imaginary_part.x);
        if (row > 0u) {
            uint opposite = column == 0u ? 0u : period - column;
            image[first + (2u * size.rows - row) * period + opposite] =
                vec2(real_part.x + imaginary_part.y, imaginary_part.x - real_part.y);
        } else {
            image[first + size.rows * period + column] = vec2(0.0); // Nyquist frequency, which no pupil passes
        }
    }
}
