#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers the window along rows: over the responses, or for the standard deviation over the channels.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = BINDING_IMAGE, scalar) readonly buffer Image { float image[]; };
layout(set = 0, binding = BINDING_RESPONSES, scalar) readonly buffer Responses { WindowSums responses[]; };
layout(set = 0, binding = BINDING_WEIGHTS, scalar) readonly buffer Weights { float weights[]; };
layout(set = 0, binding = BINDING_ROW_SUMS, scalar) writeonly buffer Rows { WindowSums row_sums[]; };

layout(push_constant, scalar) uniform Push { FocusPlan plan; };

real window_weight(int distance) { return weights[distance]; }

WindowSums window_source(int field, int column, int row) {
    WindowSums source;
    if (plan.measure == FOCUS_STANDARD_DEVIATION) {
        source.level = image[(field * plan.rows + row) * plan.columns + column];
        source.energy = real(0.0);
    } else {
        source = responses[row * plan.columns + column];
    }
    return source;
}

void main() {
    int k = int(invocation());
    if (k < plan.columns * plan.rows) {
        int row = k / plan.columns;
        int column = k - row * plan.columns;
        for (int field = 0; field < focus_fields(plan); ++field) {
            row_sums[field * plan.columns * plan.rows + k] = window_along_row(plan, field, column, row);
        }
    }
}
