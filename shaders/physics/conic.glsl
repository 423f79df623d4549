// Intersection with a conic of revolution in its vertex frame, in the curvature form that stays regular for a plane
// (curvature 0): W. T. Welford, "Aberrations of Optical Systems" (1986), section 4.3, extended by the conic constant.

// True in kernels that know their surfaces as constants, where a test of a surface's form folds away
// (device/prescription.glsl). For surfaces from a buffer the general form is as fast as a test.
#ifdef VKFV_SPECIALISED
const bool SURFACE_IS_KNOWN = true;
#else
const bool SURFACE_IS_KNOWN = false;
#endif

// The meeting of a ray with a surface of revolution, in the surface's vertex frame.
struct SurfacePoint {
    bool found;     // the ray meets the surface near its vertex
    real parameter; // position + parameter * direction is the point
    real3 point;    // mm
    real curvature; // 1/mm: the unit normal towards +z is (-curvature x, -curvature y, normal_z)
    real normal_z;
    real cosine;       // direction . normal: n cos I for a direction of length n
    real sine_squared; // |direction x normal|^2: (n sin I)^2
};

// The meeting of a ray with a conic; position and direction in its vertex frame, direction of the given length with
// direction.z > 0. From the point on the plane z = 0, with d the direction and F = c r^2, G = d_z - c (x d_x + y d_y):
// further = F / (G + sqrt(G^2 - c (|d|^2 + k d_z^2) F)), the root nearest the vertex, without cancellation. In float
// the point's height is computed by the way from that plane, its x and y by the way from the start: one rounding each.
// The normal, cosine and sine are those of a sphere (k = 0): its root is d . N, and |d x N| is the same for all points
// of the ray's line.
VKFV_FUNCTION SurfacePoint meet_conic(real3 position, real3 direction, real length_squared, real curvature,
                                      real conic) {
    real to_plane = -position.z / direction.z;
    real x = position.x + to_plane * direction.x;
    real y = position.y + to_plane * direction.y;
    real cx = curvature * x;
    real cy = curvature * y;
    real f = cx * x + cy * y;
    real g = direction.z - (cx * direction.x + cy * direction.y);
    real a = curvature * (length_squared +
                          (SURFACE_IS_KNOWN && conic == real(0.0) ? real(0.0) : conic * direction.z * direction.z));
    real discriminant = g * g - a * f;
    real root = sqrt(max(discriminant, real(0.0)));
    real further = f / (g + root);
    bool meets = discriminant >= real(0.0) && g > real(0.0);
    if (SURFACE_IS_KNOWN && curvature == real(0.0)) {
        root = direction.z;
        further = real(0.0);
        meets = true;
    }
    SurfacePoint result;
    result.found = meets;
    result.parameter = to_plane + further;
    result.point = real3(position.x + result.parameter * direction.x, position.y + result.parameter * direction.y,
                         further * direction.z);
    result.curvature = curvature;
    result.normal_z = real(1.0) - curvature * result.point.z;
    result.cosine = root;
    real across_x = direction.x + cx * direction.z;
    real across_y = direction.y + cy * direction.z;
    real skew = direction.x * cy - direction.y * cx;
    result.sine_squared = across_x * across_x + across_y * across_y + skew * skew;
    return result;
}

// Normal of the conic at a point on it, not normalised, towards +z: the gradient of z - sag, times
// 1 - (1 + k) c z (which keeps it regular at the equator).
VKFV_FUNCTION real3 conic_normal(real3 point, real curvature, real conic) {
    return real3(-curvature * point.x, -curvature * point.y, real(1.0) - curvature * (real(1.0) + conic) * point.z);
}

// The meeting with its normal replaced by one along (-slope_over_r x, -slope_over_r y, normal_z).
VKFV_FUNCTION SurfacePoint with_normal(SurfacePoint meeting, real3 direction, real slope_over_r, real normal_z) {
    real3 d = direction;
    real nx = -slope_over_r * meeting.point.x;
    real ny = -slope_over_r * meeting.point.y;
    real scale = real(1.0) / sqrt(nx * nx + ny * ny + normal_z * normal_z);
    real across_x = d.x * normal_z - nx * d.z;
    real across_y = d.y * normal_z - ny * d.z;
    real skew = d.x * ny - d.y * nx;
    SurfacePoint result = meeting;
    result.curvature = scale * slope_over_r;
    result.normal_z = scale * normal_z;
    result.cosine = scale * (d.x * nx + d.y * ny + d.z * normal_z);
    result.sine_squared = scale * scale * (across_x * across_x + across_y * across_y + skew * skew);
    return result;
}

VKFV_FUNCTION real3 normal_at(SurfacePoint meeting) {
    return real3(-meeting.curvature * meeting.point.x, -meeting.curvature * meeting.point.y, meeting.normal_z);
}
