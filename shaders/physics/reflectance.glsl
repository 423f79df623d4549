// What a map leaves of the material's reflectance where light meets the specimen: a factor in [0, 1] over x and y of
// the specimen frame, whatever the height. The pattern has a frame of its own, of which centre and axis are its origin
// and the direction of its x. Its value, 0 to 1, stands between the factors `lowest` and `highest`:
//   REFLECTANCE_GRATING       (1 + cos(2 pi u)) / 2, u in periods along the pattern's x: brightest at the origin
//   REFLECTANCE_CHECKERBOARD  1 on squares that touch the origin in the first and third quadrant, and so on
//   REFLECTANCE_STAR          (1 + cos(cycles phi)) / 2, phi the azimuth about the origin from the pattern's x
//   REFLECTANCE_GRID          bilinear between the points of a grid around the origin; beyond its outer points' pixels
//                             it goes on mirrored
// A square profile is 1 where the cosine is not negative, else 0.

#ifdef __cplusplus
template <class Scene>
real reflectance_at(const Scene& scene, int column, int row) {
    return scene.reflectance_at(column, row);
}
#else
real reflectance_at(int column, int row); // the kernel's bindings say where the grid is kept
#endif

VKFV_FUNCTION real pattern_profile(ReflectanceMap map, real cosine) {
    return map.square != 0u ? (cosine >= real(0.0) ? real(1.0) : real(0.0)) : real(0.5) + real(0.5) * cosine;
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

// The point that a whole number counts along a row of points which goes on mirrored: ... 1 0 | 0 1 ... n-1 | n-1 ...
VKFV_FUNCTION int mirrored_point(real number, int points) {
    real twice = real(2 * points);
    int place = clamp(int(number - twice * floor(number / twice)), 0, 2 * points - 1);
    return place < points ? place : 2 * points - 1 - place;
}

VKFV_SCENE_FUNCTION VKFV_FUNCTION real grid_value(VKFV_SCENE_PARAMETER ReflectanceMap map, real u, real v) {
    real column = u + real(0.5) * real(map.columns - 1);
    real row = v + real(0.5) * real(map.rows - 1);
    real first_column = floor(column);
    real first_row = floor(row);
    int left = mirrored_point(first_column, map.columns);
    int right = mirrored_point(first_column + real(1.0), map.columns);
    int lower = mirrored_point(first_row, map.rows);
    int upper = mirrored_point(first_row + real(1.0), map.rows);
    real across = column - first_column;
    real below = mix(reflectance_at(VKFV_SCENE left, lower), reflectance_at(VKFV_SCENE right, lower), across);
    real above = mix(reflectance_at(VKFV_SCENE left, upper), reflectance_at(VKFV_SCENE right, upper), across);
    return mix(below, above, row - first_row);
}

// x, y: specimen frame, mm.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real reflectance_factor(VKFV_SCENE_PARAMETER ReflectanceMap map, real x, real y) {
    real from_x = x - map.centre_x;
    real from_y = y - map.centre_y;
    // In periods, squares or points; mm for a star.
    real u = (map.axis_x * from_x + map.axis_y * from_y) * map.per_mm;
    real v = (map.axis_x * from_y - map.axis_y * from_x) * map.per_mm;
    real value = real(0.0);
    if (map.kind == REFLECTANCE_GRATING) {
        value = pattern_profile(map, turn_of(u).cosine);
    } else if (map.kind == REFLECTANCE_CHECKERBOARD) {
        value = (fract(real(0.5) * u) < real(0.5)) == (fract(real(0.5) * v) < real(0.5)) ? real(1.0) : real(0.0);
    } else if (map.kind == REFLECTANCE_STAR) {
        real radius = sqrt(u * u + v * v);
        real2 unit = radius > real(0.0) ? real2(u, v) / radius : real2(real(1.0), real(0.0));
        value = pattern_profile(map, cosine_of_multiple(unit, map.cycles));
    } else {
        value = grid_value(VKFV_SCENE map, u, v);
    }
    return map.lowest + (map.highest - map.lowest) * value;
}

// The share of its material's reflectance that the specimen has there: 1 without a map.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real reflectance_share(VKFV_SCENE_PARAMETER SpecimenRecord specimen, real3 position) {
    real share = real(1.0);
    if ((features(VKFV_SCENE_ALONE) & FEATURE_REFLECTANCE_MAP) != 0u) {
        share = reflectance_factor(VKFV_SCENE specimen.reflectance, position.x, position.y);
    }
    return share;
}

// The material there: what the map takes is absorbed.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Material material_at(VKFV_SCENE_PARAMETER SpecimenRecord specimen, real3 position) {
    Material material = specimen.material;
    if ((features(VKFV_SCENE_ALONE) & FEATURE_REFLECTANCE_MAP) != 0u) {
        real share = reflectance_share(VKFV_SCENE specimen, position);
        material.lobe_0.weight = share * material.lobe_0.weight;
        material.lobe_1.weight = share * material.lobe_1.weight;
        material.lobe_2.weight = share * material.lobe_2.weight;
        material.lobe_3.weight = share * material.lobe_3.weight;
    }
    return material;
}
