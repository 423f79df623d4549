#version 460
#extension GL_GOOGLE_include_directive : require
// Computes brightness and response of a focus measure at every pixel.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = BINDING_IMAGE, scalar) readonly buffer Image { float image[]; };
layout(set = 0, binding = BINDING_RESPONSES, scalar) writeonly buffer Responses { WindowSums responses[]; };

layout(push_constant, scalar) uniform Push { FocusPlan plan; };

real image_value(int channel, int column, int row) {
    return image[(channel * plan.rows + row) * plan.columns + column];
}

void main() {
    int k = int(invocation());
    if (k < plan.columns * plan.rows) {
        int row = k / plan.columns;
        int column = k - row * plan.columns;
        WindowSums sums;
        sums.level = brightness_at(plan, column, row);
        sums.energy = focus_response(plan, column, row);
        responses[k] = sums;
    }
}
