// Snell's law in vector form, for directions scaled by the index: the tangential part of n s is continuous.

struct Refraction {
    uint transmitted; // 0: total internal reflection
    real3 direction;  // of length index_after
};

// direction of length index_before, direction.z > 0, at a meeting with a surface.
// n's' = n s + gamma N with gamma = n' cos I' - n cos I, and sqrt(n'^2 - n^2 + (n cos I)^2) = n' cos I'. Of gamma = n'
// - n + h the greater part is a constant of the interface. h is small, and made of the small sine of incidence S = n
// sin I instead of a difference of cosines, which would lose half its digits: with q = n - n cos I = S^2 / (n + n cos
// I), primed alike, h = q - q' = S^2 (n' - n + n' cos I' - n cos I) / ((n + n cos I) (n' + n' cos I')). bend_residual:
// see Surface. The axial part is recomputed from the index: the drift of the direction's length would be the dominant
// error in float.
VKFV_FUNCTION Refraction refract_scaled(real3 direction, SurfacePoint meeting, real index_before, real index_after,
                                        real bend_residual) {
    real step = index_after - index_before;
    real p = meeting.cosine;
    real under_root = p * p + step * (index_after + index_before);
    Refraction result;
    result.transmitted = under_root >= real(0.0) ? 1u : 0u;
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
    result.transmitted = axial > real(0.0) ? result.transmitted : 0u;
    result.direction = real3(x, y, sqrt(max(axial, real(1e-30))));
    return result;
}
