// The even asphere of ISO 10110-12: a conic and a polynomial in r^2.

struct Sag {
    bool defined;      // false: r lies outside the conic
    real sag;          // mm
    real slope_over_r; // (1/r) d sag / d r, 1/mm
};

VKFV_FUNCTION Sag asphere_sag(Surface surface, real r_squared) {
    real c = surface.curvature;
    real under_root = real(1.0) - (real(1.0) + surface.conic) * c * c * r_squared;
    Sag result;
    result.defined = under_root > real(0.0);
    real root = sqrt(max(under_root, real(1e-30)));
    real q = r_squared;
    real polynomial =
        q * q *
        (surface.a4 +
         q * (surface.a6 +
              q * (surface.a8 + q * (surface.a10 + q * (surface.a12 + q * (surface.a14 + q * surface.a16))))));
    // (1/r) d/dr of a_2n r^2n is 2n a_2n r^(2n-2).
    real derivative = q * (real(4.0) * surface.a4 +
                           q * (real(6.0) * surface.a6 +
                                q * (real(8.0) * surface.a8 +
                                     q * (real(10.0) * surface.a10 +
                                          q * (real(12.0) * surface.a12 +
                                               q * (real(14.0) * surface.a14 + q * real(16.0) * surface.a16))))));
    result.sag = c * r_squared / (real(1.0) + root) + polynomial;
    result.slope_over_r = c / root + derivative;
    return result;
}

// Steps of Newton's method from the conic's intersection. The start is off by the polynomial alone (below a micrometre
// at a millimetre of radius), and the error squares each time: three steps reach rounding in float, and four more
// in double. One more leaves the normal, which is taken before the step, at a converged point.
#ifdef __cplusplus
const int ASPHERE_NEWTON_STEPS = 8;
#else
const int ASPHERE_NEWTON_STEPS = 4;
#endif

// The meeting of a ray with the surface; position and direction (of the given length) in the surface's vertex frame.
// Spheres, conics and aspheres take the same flow, with empty loops for spheres: software devices run both sides of a
// branch, but not an empty loop.
VKFV_FUNCTION SurfacePoint meet_surface(real3 position, real3 direction, real length_squared, Surface surface) {
    SurfacePoint result = meet_conic(position, direction, length_squared, surface.curvature, surface.conic);
    bool aspheric = (surface.flags & SURFACE_ASPHERIC) != 0u;
    real to_plane = -position.z / direction.z;
    real slope_over_r = surface.curvature;
    real normal_z = real(1.0) - surface.curvature * (real(1.0) + surface.conic) * result.point.z;
    int steps = aspheric ? ASPHERE_NEWTON_STEPS : 0;
    for (int step = 0; step < steps; ++step) {
        Sag sag = asphere_sag(surface, result.point.x * result.point.x + result.point.y * result.point.y);
        slope_over_r = sag.slope_over_r;
        normal_z = real(1.0);
        real approach = direction.z - slope_over_r * (direction.x * result.point.x + direction.y * result.point.y);
        result.found = sag.defined && approach > real(0.0) && result.found;
        result.parameter = result.parameter - (result.found ? (result.point.z - sag.sag) / approach : real(0.0));
        result.point = real3(position.x + result.parameter * direction.x, position.y + result.parameter * direction.y,
                             (result.parameter - to_plane) * direction.z);
    }
    int normals = aspheric || surface.conic != real(0.0) ? 1 : 0;
    for (int once = 0; once < normals; ++once) {
        result = with_normal(result, direction, slope_over_r, normal_z);
    }
    return result;
}
