// The planes of values that a kernel reads, at most MOST_PLANES: images, or curves' values.
layout(set = 0, binding = BINDING_PLANE + 0, scalar) readonly buffer Plane0 { float plane_0[]; };
layout(set = 0, binding = BINDING_PLANE + 1, scalar) readonly buffer Plane1 { float plane_1[]; };
layout(set = 0, binding = BINDING_PLANE + 2, scalar) readonly buffer Plane2 { float plane_2[]; };
layout(set = 0, binding = BINDING_PLANE + 3, scalar) readonly buffer Plane3 { float plane_3[]; };
layout(set = 0, binding = BINDING_PLANE + 4, scalar) readonly buffer Plane4 { float plane_4[]; };
layout(set = 0, binding = BINDING_PLANE + 5, scalar) readonly buffer Plane5 { float plane_5[]; };
layout(set = 0, binding = BINDING_PLANE + 6, scalar) readonly buffer Plane6 { float plane_6[]; };
layout(set = 0, binding = BINDING_PLANE + 7, scalar) readonly buffer Plane7 { float plane_7[]; };

float plane_value(int plane, uint at) {
    switch (plane) {
    case 0:
        return plane_0[at];
    case 1:
        return plane_1[at];
    case 2:
        return plane_2[at];
    case 3:
        return plane_3[at];
    case 4:
        return plane_4[at];
    case 5:
        return plane_5[at];
    case 6:
        return plane_6[at];
    default:
        return plane_7[at];
    }
}
