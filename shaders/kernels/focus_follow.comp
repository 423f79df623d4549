#version 460
#extension GL_GOOGLE_include_directive : require
// Every pixel's curve, an image further.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = 0, scalar) readonly buffer Curves { float curves[]; }; // the last `kept` images in turn
layout(set = 0, binding = 1, scalar) buffer Records { CurveRecord records[]; };
layout(set = 0, binding = 2, scalar) writeonly buffer Sharpest { int sharpest[]; };

layout(push_constant, scalar) uniform Step {
    FocusPlan plan;
    int at;
    int images;
    int kept;
};

int pixels() { return plan.columns * plan.rows; }

real curve_value(int image) { return curves[(image % kept) * pixels() + int(invocation())]; }

void main() {
    int k = int(invocation());
    if (k < pixels()) {
        CurveRecord before = empty_curve();
        if (at > 0) {
            before = records[k];
        }
        CurveStep followed = follow_curve(plan, before, at, images);
        records[k] = followed.curve;
        sharpest[k] = followed.sharpest;
    }
}
