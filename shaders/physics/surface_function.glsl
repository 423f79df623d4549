// Analytic specimens: a height over x and y with its slopes, and the meeting of a ray with it. Specimen frame, mm.
//
// shape_parameter_0 to 3 by shape (the height of every shape is 0 in the mean of its levels or on its base plane):
//   SHAPE_PLANE     slope along x, slope along y
//   SHAPE_STEP      height from the lower level (x < 0) to the upper one, width of the flank; levels -/+ height / 2
//   SHAPE_SPHERE    radius, height of the cap over the plane z = 0 (negative: depth of a dimple), less than the radius
//   SHAPE_SINUSOID  amplitude, period along x; rising through 0 at x = 0
//   SHAPE_CHIRP     amplitude, period at x_min, period at x_max; the frequency is linear in x, phase 0 at x_min

struct SurfaceHeight {
    real height;  // mm
    real slope_x; // d height / d x
    real slope_y;
};

#ifdef __cplusplus
const real SURFACE_EPSILON = std::numeric_limits<real>::epsilon();
template <class Scene>
real lattice_at(const Scene& scene, int column, int row) {
    return scene.lattice_at(column, row);
}
#else
const real SURFACE_EPSILON = 1.1920928955078125e-7;
real lattice_at(int column, int row); // the kernel's bindings say where the lattice is kept
#endif

struct SineCosine {
    real sine;
    real cosine;
};

// Of an angle in turns, to rounding in float and double: Vulkan promises no more than 2^-11 for GLSL's sin and cos.
// Taylor series about the nearest quarter turn; within 1/8 turn the first terms left out are below 1e-17.
VKFV_FUNCTION SineCosine sine_cosine_of_turns(real turns) {
    real quarters = floor(real(4.0) * turns + real(0.5));
    real angle = real(6.283185307179586477) * (turns - real(0.25) * quarters);
    real q = -angle * angle;
    real sine = real(0.0);
    real cosine = real(1.0);
    real term = real(1.0);
    for (int n = 1; n <= 9; ++n) {
        sine = sine + term / real(2 * n - 1);
        term = term * q / real((2 * n - 1) * (2 * n));
        cosine = cosine + term;
        term = term * real(2 * n);
    }
    return SineCosine(sine * angle, cosine);
}
