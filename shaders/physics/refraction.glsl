// Snell's law: n sin I is the same on both sides of an interface.

struct Refraction {
    bool transmitted; // false: totally reflected
    real3 direction;  // as long as index_after
};

// Snell's law for the angle alone: sin^2 behind the interface; 1 or more means total reflection.
VKFV_FUNCTION real refracted_sine_squared(real index_before, real index_after, real cosine) {
    real ratio = index_before / index_after;
    return ratio * ratio * (real(1.0) - cosine * cosine);
}

// Snell's law in vector form for a unit direction whose angle with the unit normal ahead has the given cosine, without
// a test for total reflection.
VKFV_FUNCTION real3 refract_unit(real3 direction, real3 normal, real index_before, real index_after, real cosine) {
    real ratio = index_before / index_after;
    real sine_squared = refracted_sine_squared(index_before, index_after, cosine);
    return direction * ratio + normal * (sqrt(max(real(1.0) - sine_squared, real(0.0))) - ratio * cosine);
}

// Snell's law in vector form for directions scaled by the index: the tangential part of n s is continuous. direction of
// length index_before, direction.z > 0, at a meeting with a surface. n's' = n s + gamma N with gamma = n' cos I' - n
// cos I, and sqrt(n'^2 - n^2 + (n cos I)^2) = n' cos I'. The greater part of gamma = n' - n + h is a constant of the
// interface. h is small, and made of the small sine of incidence S = n sin I instead of a difference of cosines, which
// would lose half its digits: with q = n - n cos I = S^2 / (n + n cos I), primed alike, h = q - q' = S^2 (n' - n + n'
// cos I' - n cos I) / ((n + n cos I) (n' + n' cos I')). bend_residual:
// see Surface. The axial part is recomputed from the index: the drift of the direction's length would be the dominant
// error in float.
VKFV_FUNCTION Refraction refract_scaled(real3 direction, SurfacePoint meeting, real index_before, real index_after,
                                        real bend_residual) {
    real step = index_after - index_before;
    real p = meeting.cosine;
    real under_root = p * p + step * (index_after + index_before);
    Refraction result;
    result.transmitted = under_root >= real(0.0);
    real p_after = sqrt(max(under_root, real(0.0)));
    real h = meeting.sine_squared * (step + (p_after - p)) / ((index_before + p) * (index_after + p_after));
    real paraxial = meeting.curvature * step;
    real rest = meeting.curvature * h + bend_residual;
    real x = (direction.x - paraxial * meeting.point.x) - rest * meeting.point.x;
    real y = (direction.y - paraxial * meeting.point.y) - rest * meeting.point.y;
    if (SURFACE_IS_KNOWN && meeting.curvature == real(0.0)) {
        x = direction.x;
        y = direction.y;
    }
    real axial = index_after * index_after - (x * x + y * y);
    // A ray that would travel at right angles to the axis or backward has left the sequential model.
    result.transmitted = axial > real(0.0) && result.transmitted;
    result.direction = real3(x, y, sqrt(max(axial, real(1e-30))));
    return result;
}
