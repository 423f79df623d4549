// Intersection with a conic of revolution in its vertex frame, in the curvature form that stays regular for a plane
// (curvature 0): W. T. Welford, "Aberrations of Optical Systems" (1986), section 4.3, extended by the conic constant.

struct Intersection {
    uint found;    // 1: the ray meets the surface near its vertex
    real parameter; // position + parameter * direction is the point
};

// position and direction in the vertex frame, direction of any length with direction.z > 0.
// From the point on the plane z = 0, with d the direction and F = c r^2, G = d_z - c (x d_x + y d_y):
// parameter = F / (G + sqrt(G^2 - c (|d|^2 + k d_z^2) F)), the root nearest the vertex, without cancellation.
VKFV_FUNCTION Intersection intersect_conic(real3 position, real3 direction, real curvature, real conic) {
    real to_plane = -position.z / direction.z;
    real x = position.x + to_plane * direction.x;
    real y = position.y + to_plane * direction.y;
    real f = curvature * (x * x + y * y);
    real g = direction.z - curvature * (x * direction.x + y * direction.y);
    real length_squared =
        direction.x * direction.x + direction.y * direction.y + direction.z * direction.z;
    real a = curvature * (length_squared + conic * direction.z * direction.z);
    real discriminant = g * g - a * f;
    Intersection result;
    result.found = discriminant >= real(0.0) && g > real(0.0) ? 1u : 0u;
    result.parameter = to_plane + f / (g + sqrt(max(discriminant, real(0.0))));
    return result;
}

// Normal of the conic at a point on it, not normalised, towards +z: the gradient of z - sag, times
// 1 - (1 + k) c z (which keeps it regular at the equator).
VKFV_FUNCTION real3 conic_normal(real3 point, real curvature, real conic) {
    return real3(-curvature * point.x, -curvature * point.y,
                 real(1.0) - curvature * (real(1.0) + conic) * point.z);
}
