// Patterns: a factor in [0, 1] over x and y of a plane. A pattern has its own frame: `centre` is its origin, `axis` the
// direction of its x. Its value, 0 to 1, is scaled to the range between the factors `lowest` and `highest`:
//   PATTERN_GRATING       (1 + cos(2 pi u)) / 2, u in periods along the pattern's x: brightest at the origin
//   PATTERN_CHECKERBOARD  1 on squares that touch the origin in the first and third quadrant, and so on
//   PATTERN_STAR          (1 + cos(cycles phi)) / 2, phi the azimuth about the origin from the pattern's x
//   PATTERN_GRID          bilinear between the points of a grid around the origin; beyond its outer points' pixels it
//                         goes on mirrored
// A square profile is 1 where the cosine is not negative, else 0.

#ifdef __cplusplus
template <class Scene>
real pattern_point(const Scene& scene, Pattern pattern, int column, int row) {
    return scene.pattern_point(pattern, column, row);
}
#else
real pattern_point(Pattern pattern, int column, int row); // the kernel's bindings say where grids are kept
#endif

VKFV_FUNCTION real pattern_profile(Pattern pattern, real cosine) {
    return pattern.square != 0u ? (cosine >= real(0.0) ? real(1.0) : real(0.0)) : real(0.5) + real(0.5) * cosine;
}

// cos(n phi) of the unit vector at phi: its n-th power as a complex number, by squares.
VKFV_FUNCTION real cosine_of_multiple(real2 unit, int n) {
    real2 power = real2(real(1.0), real(0.0));
    real2 square = unit;
    for (int rest = n; rest > 0; rest = rest >> 1) {
        if ((rest & 1) != 0) {
            power = real2(power.x * square.x - power.y * square.y, power.x * square.y + power.y * square.x);
        }
        square = real2(square.x * square.x - square.y * square.y, real(2.0) * square.x * square.y);
    }
    return power.x;
}

// The point for a whole number along a row of points that goes on mirrored: ... 1 0 | 0 1 ... n-1 | n-1 ...
VKFV_FUNCTION int mirrored_point(real number, int points) {
    real twice = real(2 * points);
    int place = clamp(int(number - twice * floor(number / twice)), 0, 2 * points - 1);
    return place < points ? place : 2 * points - 1 - place;
}

VKFV_SCENE_FUNCTION VKFV_FUNCTION real grid_value(VKFV_SCENE_PARAMETER Pattern pattern, real u, real v) {
    real column = u + real(0.5) * real(pattern.columns - 1);
    real row = v + real(0.5) * real(pattern.rows - 1);
    real first_column = floor(column);
    real first_row = floor(row);
    int left = mirrored_point(first_column, pattern.columns);
    int right = mirrored_point(first_column + real(1.0), pattern.columns);
    int lower = mirrored_point(first_row, pattern.rows);
    int upper = mirrored_point(first_row + real(1.0), pattern.rows);
    real across = column - first_column;
    real below =
        mix(pattern_point(VKFV_SCENE pattern, left, lower), pattern_point(VKFV_SCENE pattern, right, lower), across);
    real above =
        mix(pattern_point(VKFV_SCENE pattern, left, upper), pattern_point(VKFV_SCENE pattern, right, upper), across);
    return mix(below, above, row - first_row);
}

// The factor of a pattern. x, y: mm, in the frame of the plane.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real pattern_factor(VKFV_SCENE_PARAMETER Pattern pattern, real x, real y) {
    real from_x = x - pattern.centre_x;
    real from_y = y - pattern.centre_y;
    // The coordinates u and v are in periods, squares or points; mm for a star.
    real u = (pattern.axis_x * from_x + pattern.axis_y * from_y) * pattern.per_mm;
    real v = (pattern.axis_x * from_y - pattern.axis_y * from_x) * pattern.per_mm;
    real value = real(0.0);
    if (pattern.kind == PATTERN_GRATING) {
        value = pattern_profile(pattern, turn_of(u).cosine);
    } else if (pattern.kind == PATTERN_CHECKERBOARD) {
        value = (fract(real(0.5) * u) < real(0.5)) == (fract(real(0.5) * v) < real(0.5)) ? real(1.0) : real(0.0);
    } else if (pattern.kind == PATTERN_STAR) {
        real radius = sqrt(u * u + v * v);
        real2 unit = radius > real(0.0) ? real2(u, v) / radius : real2(real(1.0), real(0.0));
        value = pattern_profile(pattern, cosine_of_multiple(unit, pattern.cycles));
    } else {
        value = grid_value(VKFV_SCENE pattern, u, v);
    }
    return pattern.lowest + (pattern.highest - pattern.lowest) * value;
}
