#version 460
#extension GL_GOOGLE_include_directive : require
// Adds to the all-in-focus image those pixels whose focus lies beside these images, weighted by share_in_focus().
layout(local_size_x = 128) in;

#include "focus/device.glsl"
#include "focus/planes.glsl"

layout(set = 0, binding = BINDING_PLACES, scalar) readonly buffer Places { float places[]; };
layout(set = 0, binding = BINDING_ALL_IN_FOCUS, scalar) buffer AllInFocus { float all_in_focus[]; };

layout(push_constant, scalar) uniform Push { SelectedImages selected; };

void main() {
    uint k = invocation();
    if (k < selected.pixels && places[k] != NO_PLACE) {
        for (int plane = 0; plane < selected.planes; ++plane) {
            int wanted = selected.first + plane;
            float share = share_in_focus(places[k], wanted);
            bool first = int(floor(places[k])) == wanted; // images come in ascending order
            for (uint channel = 0u; channel < selected.channels && share > 0.0; ++channel) {
                uint at = channel * selected.pixels + k;
                float value = share * plane_value(plane, at);
                all_in_focus[at] = first ? value : all_in_focus[at] + value;
            }
        }
    }
}
