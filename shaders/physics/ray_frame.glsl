// The ray's frame, in which triangle corners have coordinates from the ray's origin: two across the ray, the third
// along it. As in S. Woop, C. Benthin, I. Wald, "Watertight ray/triangle intersection", JCGT 2 (2013) 1, a corner has
// the same coordinates in every triangle, and the edge functions of neighbours have opposite signs on their common
// edge, since a difference of two rounded products may round to zero but never to the wrong sign; zero counts as
// inside. So no ray passes between the two, as long as nothing is contracted: hence VKFV_PRECISE. Instead of a shear
// along the largest axis, a rotation is used (T. Duff et al., "Building an orthonormal basis, revisited", JCGT 6 (2017)
// 1).
struct RayFrame {
    real3 origin;
    real3 from_x; // new coordinates of a unit step along x; from_y and from_z: along y and z
    real3 from_y;
    real3 from_z;
};

VKFV_FUNCTION RayFrame ray_frame(real3 origin, real3 direction) {
    real side = direction.z >= real(0.0) ? real(1.0) : real(-1.0);
    real a = real(-1.0) / (side + direction.z);
    real b = direction.x * direction.y * a;
    RayFrame frame;
    frame.origin = origin;
    frame.from_x = real3(real(1.0) + side * direction.x * direction.x * a, b, direction.x);
    frame.from_y = real3(side * b, side + direction.y * direction.y * a, direction.y);
    frame.from_z = real3(-side * direction.x, -direction.y, direction.z);
    return frame;
}

VKFV_FUNCTION real3 in_frame(RayFrame frame, real3 point) {
    VKFV_PRECISE real3 offset = point - frame.origin;
    VKFV_PRECISE real3 result =
        fma(real3(offset.x), frame.from_x, fma(real3(offset.y), frame.from_y, offset.z * frame.from_z));
    return result;
}
