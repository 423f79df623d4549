#version 460
#extension GL_GOOGLE_include_directive : require
// Follows every pixel's curve by one image.
layout(local_size_x = 128) in;

#include "focus/device.glsl"

layout(set = 0, binding = BINDING_CURVES, scalar) readonly buffer Curves { float curves[]; };
layout(set = 0, binding = BINDING_JOINT, scalar) readonly buffer Joint { float joint[]; };
layout(set = 0, binding = BINDING_ALONE, scalar) readonly buffer Alone { float alone[]; };
layout(set = 0, binding = BINDING_RECORDS, scalar) buffer Records { CurveRecord records[]; };
layout(set = 0, binding = BINDING_PLACES, scalar) writeonly buffer Places { float places[]; };

layout(push_constant, scalar) uniform Push { FollowedImage image; };

int pixels() { return image.plan.columns * image.plan.rows; }

int place_of(int at) { return (at % image.kept) * pixels() + int(invocation()); }

real curve_value(int at) { return curves[place_of(at)]; }

real joint_value(int at) { return joint[place_of(at)]; }

real alone_value(int at) { return alone[place_of(at)]; }

void main() {
    int k = int(invocation());
    if (k < pixels()) {
        CurveRecord before = empty_curve();
        if (image.at > 0) {
            before = records[k];
        }
        CurveStep followed = follow_curve(image.plan, before, image.at, image.images);
        records[k] = followed.curve;
        places[k] = followed.place;
    }
}
