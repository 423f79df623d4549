// The aplanatic lens: it images its front focal plane to infinity without aberration and obeys Abbe's sine condition.
// In positions x on the focal planes and direction cosines p scaled by the index, it is the Fourier lens x' = p /
// power, p' = -power x: linear and canonical, so it keeps etendue at any angle (as a thin lens of tangents does not).

struct IdealLens {
    bool passes;      // false: no direction has these cosines
    real3 position;   // on the back focal plane, in the frame of the lens (principal planes at z = 0)
    real3 direction;  // as long as the index
    real path_length; // mm, optical path from the given point to the back focal plane
};

// Light through the lens; position and direction (of length index_before) in the frame of the lens, anywhere in front
// of it.
VKFV_FUNCTION IdealLens pass_ideal_lens(real3 position, real3 direction, real power, real index_before,
                                        real index_after) {
    real focal_length = real(1.0) / power;
    real to_focal_plane = (-index_before * focal_length - position.z) / direction.z;
    real x = position.x + to_focal_plane * direction.x;
    real y = position.y + to_focal_plane * direction.y;
    real p = -power * x;
    real q = -power * y;
    real axial = index_after * index_after - p * p - q * q;
    IdealLens lens;
    lens.passes = axial > real(0.0);
    lens.position = real3(focal_length * direction.x, focal_length * direction.y, index_after * focal_length);
    lens.direction = real3(p, q, sqrt(max(axial, real(1e-30))));
    // The point characteristic between the focal planes is f (n^2 + n'^2) - x x' / f.
    lens.path_length = to_focal_plane * index_before * index_before +
                       focal_length * (index_before * index_before + index_after * index_after) + p * lens.position.x +
                       q * lens.position.y;
    return lens;
}
