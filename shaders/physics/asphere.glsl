// The even asphere of ISO 10110-12: a conic and a polynomial in r^2.

struct Sag {
    uint defined; // 0: r lies outside the conic
    real sag;     // mm
    real slope_over_r; // (1/r) d sag / d r, 1/mm
};

VKFV_FUNCTION Sag asphere_sag(Surface surface, real r_squared) {
    real c = surface.curvature;
    real under_root = real(1.0) - (real(1.0) + surface.conic) * c * c * r_squared;
    Sag result;
    result.defined = under_root > real(0.0) ? 1u : 0u;
    real root = sqrt(max(under_root, real(1e-30)));
    real q = r_squared;
    real polynomial =
        q * q *
        (surface.a4 +
         q * (surface.a6 +
              q * (surface.a8 +
                   q * (surface.a10 + q * (surface.a12 + q * (surface.a14 + q * surface.a16))))));
    // (1/r) d/dr of a_2n r^2n is 2n a_2n r^(2n-2).
    real derivative =
        q * (real(4.0) * surface.a4 +
             q * (real(6.0) * surface.a6 +
                  q * (real(8.0) * surface.a8 +
                       q * (real(10.0) * surface.a10 +
                            q * (real(12.0) * surface.a12 +
                                 q * (real(14.0) * surface.a14 + q * real(16.0) * surface.a16))))));
    result.sag = c * r_squared / (real(1.0) + root) + polynomial;
    result.slope_over_r = c / root + derivative;
    return result;
}

// Newton's method from the conic's intersection. The start is off by the polynomial alone (micrometres on lenses of
// millimetres), so the error squares each time: eight steps leave rounding in double; fewer never hurt, as a
// converged step is zero.
const int ASPHERE_NEWTON_STEPS = 8;

VKFV_FUNCTION Intersection intersect_asphere(real3 position, real3 direction, Surface surface) {
    Intersection result = intersect_conic(position, direction, surface.curvature, surface.conic);
    for (int step = 0; step < ASPHERE_NEWTON_STEPS; ++step) {
        real3 point = position + result.parameter * direction;
        Sag sag = asphere_sag(surface, point.x * point.x + point.y * point.y);
        real residual = point.z - sag.sag;
        real derivative = direction.z -
                          sag.slope_over_r * (point.x * direction.x + point.y * direction.y);
        result.found = sag.defined == 1u && derivative > real(0.0) ? result.found : 0u;
        result.parameter = result.parameter - (result.found == 1u ? residual / derivative : real(0.0));
    }
    return result;
}

VKFV_FUNCTION real3 asphere_normal(real3 point, Surface surface) {
    Sag sag = asphere_sag(surface, point.x * point.x + point.y * point.y);
    return real3(-sag.slope_over_r * point.x, -sag.slope_over_r * point.y, real(1.0));
}
