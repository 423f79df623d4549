// Analytic specimens: a height over x and y with its slopes, and the meeting of a ray with it. Specimen frame, mm.
//
// shape_parameter_0 to 2 by shape:
//   SHAPE_PLANE     slope along x, slope along y
//   SHAPE_STEP      height of the upper level (x > 0) over the lower, which stand at +/- height / 2; width of the
//                   straight flank, centred on x = 0
//   SHAPE_SPHERE    radius, height of the cap over the plane z = 0 (negative: depth of a dimple), less than the radius
//   SHAPE_SINUSOID  amplitude, period; along x, rising through 0 at x = 0
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
const real SURFACE_EPSILON = real(1.1920928955078125e-7);
real lattice_at(int column, int row); // the kernel's bindings say where the lattice is kept
#endif

VKFV_FUNCTION SurfaceHeight shape_height(SpecimenRecord specimen, real x, real y) {
    SurfaceHeight result;
    result.height = real(0.0);
    result.slope_x = real(0.0);
    result.slope_y = real(0.0);
    if (specimen.shape == SHAPE_PLANE) {
        result.slope_x = specimen.shape_parameter_0;
        result.slope_y = specimen.shape_parameter_1;
        result.height = result.slope_x * x + result.slope_y * y;
    } else if (specimen.shape == SHAPE_STEP) {
        real step_height = specimen.shape_parameter_0;
        real across = x / specimen.shape_parameter_1; // -1/2 to 1/2 on the flank
        result.height = step_height * clamp(across, real(-0.5), real(0.5));
        result.slope_x = abs(across) < real(0.5) ? step_height / specimen.shape_parameter_1 : real(0.0);
    } else if (specimen.shape == SHAPE_SPHERE) {
        real radius = specimen.shape_parameter_0;
        real cap = abs(specimen.shape_parameter_1);
        real side = specimen.shape_parameter_1 < real(0.0) ? real(-1.0) : real(1.0);
        real r_squared = x * x + y * y;
        real root = sqrt(max(radius * radius - r_squared, real(0.0)));
        real over_plane = cap - r_squared / (radius + root); // the sag without cancellation
        if (root > real(0.0) && over_plane > real(0.0)) {
            result.height = side * over_plane;
            result.slope_x = -side * x / root;
            result.slope_y = -side * y / root;
        }
    } else {
        real phase; // turns
        real frequency;
        if (specimen.shape == SHAPE_SINUSOID) {
            frequency = real(1.0) / specimen.shape_parameter_1;
            phase = x * frequency;
        } else {
            real start = real(1.0) / specimen.shape_parameter_1;
            real stop = real(1.0) / specimen.shape_parameter_2;
            real s = clamp(x, specimen.x_min, specimen.x_max) - specimen.x_min;
            real sweep = (stop - start) / (specimen.x_max - specimen.x_min);
            frequency = start + sweep * s;
            phase = (start + real(0.5) * sweep * s) * s;
        }
        Turn wave = turn_of(phase);
        result.height = specimen.shape_parameter_0 * wave.sine;
        result.slope_x = specimen.shape_parameter_0 * real(6.283185307179586477) * frequency * wave.cosine;
    }
    return result;
}

// Weights of four neighbouring points for the value and the derivative (per pitch) at a fraction of the middle
// interval: R. G. Keys, "Cubic convolution interpolation for digital image processing", IEEE Trans. ASSP 29 (1981),
// a = -1/2 (Catmull-Rom). It passes through the points and its slope is continuous.
struct CubicWeights {
    real value[4];
    real derivative[4];
};

VKFV_FUNCTION CubicWeights cubic_weights(real u) {
    CubicWeights w;
    w.value[0] = real(0.5) * u * (real(-1.0) + u * (real(2.0) - u));
    w.value[1] = real(1.0) + real(0.5) * u * u * (real(3.0) * u - real(5.0));
    w.value[2] = real(0.5) * u * (real(1.0) + u * (real(4.0) - real(3.0) * u));
    w.value[3] = real(0.5) * u * u * (u - real(1.0));
    w.derivative[0] = real(-0.5) + u * (real(2.0) - real(1.5) * u);
    w.derivative[1] = u * (real(4.5) * u - real(5.0));
    w.derivative[2] = real(0.5) + u * (real(4.0) - real(4.5) * u);
    w.derivative[3] = u * (real(1.5) * u - real(1.0));
    return w;
}

// Height of an analytic specimen: the shape, and the lattice interpolated on it where there is one (columns > 0; at
// least 2 x 2 points). Beyond the footprint the lattice goes on level.
VKFV_SCENE_FUNCTION VKFV_FUNCTION SurfaceHeight surface_height(VKFV_SCENE_PARAMETER SpecimenRecord specimen, real x,
                                                               real y) {
    SurfaceHeight result = shape_height(specimen, x, y);
    if (specimen.columns > 0) {
        real across = (x - specimen.x_min) / specimen.pitch_x;
        real along = (y - specimen.y_min) / specimen.pitch_y;
        int column = clamp(int(floor(across)), 0, specimen.columns - 2);
        int row = clamp(int(floor(along)), 0, specimen.rows - 2);
        CubicWeights wx = cubic_weights(clamp(across - real(column), real(0.0), real(1.0)));
        CubicWeights wy = cubic_weights(clamp(along - real(row), real(0.0), real(1.0)));
        for (int j = 0; j < 4; ++j) {
            real value = real(0.0);
            real derivative = real(0.0);
            for (int i = 0; i < 4; ++i) {
                real point = lattice_at(VKFV_SCENE clamp(column + i - 1, 0, specimen.columns - 1),
                                        clamp(row + j - 1, 0, specimen.rows - 1));
                value = value + wx.value[i] * point;
                derivative = derivative + wx.derivative[i] * point;
            }
            result.height = result.height + wy.value[j] * value;
            result.slope_x = result.slope_x + wy.value[j] * derivative / specimen.pitch_x;
            result.slope_y = result.slope_y + wy.derivative[j] * value / specimen.pitch_y;
        }
    }
    return result;
}

// The part of a ray between two planes lower <= coordinate <= upper; empty where stop < start.
struct RayInterval {
    real start;
    real stop;
};

VKFV_FUNCTION RayInterval clip_interval(RayInterval interval, real origin, real direction, real lower, real upper) {
    RayInterval result = interval;
    if (direction == real(0.0)) {
        result.stop = origin < lower || origin > upper ? result.start - real(1.0) : result.stop;
    } else {
        real to_lower = (lower - origin) / direction;
        real to_upper = (upper - origin) / direction;
        result.start = max(result.start, min(to_lower, to_upper));
        result.stop = min(result.stop, max(to_lower, to_upper));
    }
    return result;
}

// Limits of a march: at most MARCH_STEPS steps that the slope's bound proves safe, then at most MARCH_COARSE_STEPS that
// cover the rest. A chord of a coarse step's length c below the surface may be missed, which is a graze not deeper than
// c^2 / 8 over the radius of curvature (for a ray at NA 0.28 through 10 um of relief and a radius of 1 um: 0.01 nm).
const int MARCH_STEPS = 256;
const int MARCH_COARSE_STEPS = 1024;
// Halvings from a coarse step to the last bit of a double: 52 - 10, and as many Newton steps, which may fail.
const int MARCH_POLISH_STEPS = 84;

// The nearest crossing of the continuous surface with t_min <= t <= t_max, within the footprint. direction: unit. Safe
// steps: along the ray the gap z - f(x, y) shrinks by at most lipschitz |d_xy| - d_z a unit length (J. C. Hart, "Sphere
// tracing", The Visual Computer 12 (1996), for the vertical distance instead of the Euclidean one). A ray that starts
// below the surface by more than rounding is met at once, at t_min: scattered light cannot leak. One that comes in
// through a side of the footprint below the surface meets it from below. position.z is the surface's height, so that a
// ray that starts there starts on the surface; the normal is on the side of +z.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Hit march_surface(VKFV_SCENE_PARAMETER SpecimenRecord specimen, real3 origin,
                                                    real3 direction, real t_min, real t_max) {
    real lateral = sqrt(direction.x * direction.x + direction.y * direction.y);
    // Bound of the gap's rounding: an ulp or two of each coordinate that enters it, the lateral ones times slope.
    real rounding = real(4.0) * SURFACE_EPSILON *
                    (abs(origin.z) + max(abs(specimen.bottom), abs(specimen.top)) +
                     specimen.lipschitz * (abs(origin.x) + abs(origin.y) + abs(specimen.x_min) + abs(specimen.x_max) +
                                           abs(specimen.y_min) + abs(specimen.y_max)));
    // Bound of the rounding of the rate at which a tangential ray approaches.
    real undecided = real(8.0) * SURFACE_EPSILON * (real(1.0) + specimen.lipschitz);
    RayInterval inside;
    inside.start = t_min;
    inside.stop = t_max;
    inside = clip_interval(inside, origin.x, direction.x, specimen.x_min, specimen.x_max);
    inside = clip_interval(inside, origin.y, direction.y, specimen.y_min, specimen.y_max);
    inside = clip_interval(inside, origin.z, direction.z, specimen.bottom - rounding, specimen.top + rounding);

    // The march starts at the place of entry, so that the steps keep their digits.
    real3 start = origin + inside.start * direction;
    real way = inside.stop - inside.start;
    Hit result;
    result.found = 0u;
    result.distance = inside.stop;
    result.position = start;
    result.normal = real3(real(0.0), real(0.0), real(1.0));
    if (!(way >= real(0.0))) {
        return result;
    }

    SurfaceHeight surface = surface_height(VKFV_SCENE specimen, start.x, start.y);
    real gap = start.z - surface.height;
    bool entered = inside.start > t_min;
    real side = entered && gap < real(0.0) ? real(-1.0) : real(1.0); // side of the surface that the ray is on
    real closing = specimen.lipschitz * lateral - side * direction.z;
    gap = side * gap;
    real s = real(0.0);        // distance from start
    real previous = real(0.0); // place on the ray's side of the surface
    bool met = false;
    for (int step = 0; step < MARCH_STEPS + MARCH_COARSE_STEPS; ++step) {
        real rate = side * (direction.z - surface.slope_x * direction.x - surface.slope_y * direction.y);
        // A ray that leaves a point of the surface is within rounding of it, but not approaching.
        met = gap < -rounding || (gap <= rounding && rate < -undecided);
        if (met || closing <= real(0.0) || s >= way) {
            break;
        }
        real forward = max(gap, rounding) / closing;
        if (step >= MARCH_STEPS) {
            forward = max(forward, way / real(MARCH_COARSE_STEPS));
        }
        previous = s;
        s = min(max(s + forward, s * (real(1.0) + real(2.0) * SURFACE_EPSILON)), way);
        real3 point = start + s * direction;
        surface = surface_height(VKFV_SCENE specimen, point.x, point.y);
        gap = side * (point.z - surface.height);
    }
    if (!met) {
        return result;
    }

    // Newton's method, held by bisection between the last point before the surface and the first behind it.
    real lower = previous;
    real upper = s;
    for (int step = 0; step < MARCH_POLISH_STEPS && abs(gap) > rounding && upper > lower; ++step) {
        real rate = side * (direction.z - surface.slope_x * direction.x - surface.slope_y * direction.y);
        real newton = s - gap / rate;
        bool held = (step & 1) == 0 && newton > lower && newton < upper;
        s = held ? newton : real(0.5) * (lower + upper);
        real3 point = start + s * direction;
        surface = surface_height(VKFV_SCENE specimen, point.x, point.y);
        gap = side * (point.z - surface.height);
        if (gap < real(0.0)) {
            upper = s;
        } else {
            lower = s;
        }
    }
    real3 point = start + s * direction;
    result.found = 1u;
    result.distance = inside.start + s;
    result.position = real3(point.x, point.y, surface.height);
    real scale = real(1.0) / sqrt(real(1.0) + surface.slope_x * surface.slope_x + surface.slope_y * surface.slope_y);
    result.normal = real3(-surface.slope_x * scale, -surface.slope_y * scale, scale);
    return result;
}
