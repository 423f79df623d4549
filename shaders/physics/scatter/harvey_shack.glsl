// Scatter of a polished surface as found by J. E. Harvey, "Light-scattering characteristics of optical surfaces"
// (thesis, University of Arizona, 1976), the same at any incidence as a function of direction cosines:
//   f = f_0 (1 + (d / shoulder)^2)^(slope / 2),
// where d is the distance of the outgoing direction's cosines from the mirror direction's. f_0 makes the integral of f
// cos(theta) 1 at normal incidence, so that the lobe's weight is the total integrated scatter. The model is reciprocal;
// at other incidences the part of the lobe beyond the horizon is absorbed. The unscattered light is a lobe of mirror.
// parameter: shoulder, 0.0001, 1, 0.01, distance of direction cosines at which the lobe rolls off
// parameter: slope, -8, -0.1, -1.5, slope of the lobe beyond the shoulder, both axes logarithmic
// lossy
// table

// With l = log(1 + (d / shoulder)^2) the density over l is exp(p l), p = 1 + slope / 2, up to d = 1.
VKFV_FUNCTION real harvey_shack_distance(real shoulder, real slope, real u) {
    real p = real(1.0) + real(0.5) * slope;
    real last = log((real(1.0) + shoulder * shoulder) / (shoulder * shoulder));
    // exp(p l) is formed without cancellation where it is small.
    bool far = p < real(0.0) && u > real(0.25);
    real grown = far ? log((real(1.0) - u) + u * exp(p * last)) : log_one_plus(u * exp_minus_one(p * last));
    real l = abs(p) < real(1e-6) ? u * last : grown / p;
    return min(shoulder * sqrt(exp_minus_one(l)), real(1.0));
}

VKFV_FUNCTION real harvey_shack_power(real shoulder, real slope, real distance_squared) {
    return exp(real(0.5) * slope * log_one_plus(distance_squared / (shoulder * shoulder)));
}

VKFV_FUNCTION ScatterTry harvey_shack_try(real shoulder, real slope, Incidence incidence, real u0, real u1, real u2) {
    real distance = harvey_shack_distance(shoulder, slope, u0);
    CosinesDraw drawn = draw_in_cosines(incidence, distance, u1);
    bool kept = true;
    if (drawn.folded) {
        kept = u2 * harvey_shack_power(shoulder, slope, distance * distance) <
               harvey_shack_power(shoulder, slope, drawn.distance * drawn.distance);
    }
    ScatterTry result;
    result.absorbed = false;
    result.direction = drawn.direction;
    result.accepted = drawn.above && kept;
    return result;
}

// The BSDF; f_0 is table[0].
VKFV_FUNCTION real harvey_shack_bsdf(real shoulder, real slope, real table[LOBE_TABLE_SIZE], Incidence incidence,
                                     real3 outgoing) {
    return table[0] * harvey_shack_power(shoulder, slope, cosines_apart_squared(incidence, outgoing));
}
