#version 460
#extension GL_GOOGLE_include_directive : require
// Gathers the window along columns, and makes the focus measure.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = BINDING_ROW_SUMS, scalar) readonly buffer Rows { WindowSums row_sums[]; };
layout(set = 0, binding = BINDING_WEIGHTS, scalar) readonly buffer Weights { float weights[]; };
layout(set = 0, binding = BINDING_CURVE, scalar) writeonly buffer Curve { float curve[]; };

layout(push_constant, scalar) uniform Push { FocusPlan plan; };

real window_weight(int distance) { return weights[distance]; }

WindowSums window_row(int field, int column, int row) {
    return row_sums[(field * plan.rows + row) * plan.columns + column];
}

void main() {
    int k = int(invocation());
    if (k < plan.columns * plan.rows) {
        int row = k / plan.columns;
        int column = k - row * plan.columns;
        curve[k] = focus_value(plan, column, row);
    }
}
