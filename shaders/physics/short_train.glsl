// trace_train() in its short form: light through a train of centred surfaces without a branch at each. A surface missed
// or total reflection makes a radicand negative, and the not-a-number goes through to the end, where it is seen; only
// then is the ray traced again in the long form, which finds its status and surface. For edges one predicate is kept,
// and the number of surfaces that were passed while it held.

// Features that need the long form; other instruments are traced in the short form.
const uint FEATURES_OF_LONG_TRAINS = FEATURE_PLACEMENT | FEATURE_LOSSES | FEATURE_IDEAL_LENS;

// Accuracy of the short form in float: to nanometres, as the detector needs, or to a tenth of a micrometre, for light
// of the source, whose place on the specimen matters little.
const uint SHORT_TRAIN_FINE = 1u;
const uint SHORT_TRAIN_PLAIN = 2u;

struct ShortTrain {
    real3 position;
    real3 direction; // as long as the index
    real steepness;  // 1 / direction.z
    real index;      // index of the medium that the ray is in
    bool within;     // true while the ray was within every edge so far
    int passed;      // number of surfaces passed while it was within
};

// Passes a sphere or plane as meet_conic() and refract_scaled() do, without their branches: for a sphere the
// discriminant is negative wherever the ray comes to the vertex's plane from behind the surface (G <= 0 there, and |G|
// is then less than c r |d|).
VKFV_FUNCTION ShortTrain pass_sphere(Surface surface, ShortTrain before, real index_after, uint form) {
    real3 d = before.direction;
    real c = surface.curvature;
    real step = index_after - before.index;
    real to_plane = (surface.distance - before.position.z) * before.steepness;
    real x = before.position.x + to_plane * d.x;
    real y = before.position.y + to_plane * d.y;
    real cx = c * x;
    real cy = c * y;
    real f = cx * x + cy * y;
    real g = d.z - (cx * d.x + cy * d.y);
    real cosine = sqrt(g * g - c * before.index * before.index * f);
    real further = f / (g + cosine);
    if (SURFACE_IS_KNOWN && c == real(0.0)) {
        cosine = d.z;
        further = real(0.0);
    }
    real parameter = to_plane + further;
    ShortTrain after = before;
    after.position = real3(before.position.x + parameter * d.x, before.position.y + parameter * d.y, further * d.z);
    after.index = index_after;
    if (!(SURFACE_IS_KNOWN && step == real(0.0))) {
        real cosine_after = sqrt(cosine * cosine + step * (index_after + before.index));
        real bend = c * (cosine_after - cosine);
        if (form == SHORT_TRAIN_FINE) {
            real across_x = d.x + cx * d.z;
            real across_y = d.y + cy * d.z;
            real skew = d.x * cy - d.y * cx;
            real sine_squared = across_x * across_x + across_y * across_y + skew * skew;
            real h = sine_squared * (step + (cosine_after - cosine)) /
                     ((before.index + cosine) * (index_after + cosine_after));
            bend = c * h + surface.bend_residual;
            d.x = d.x - c * step * after.position.x;
            d.y = d.y - c * step * after.position.y;
        }
        if (!(SURFACE_IS_KNOWN && c == real(0.0))) {
            d.x = d.x - bend * after.position.x;
            d.y = d.y - bend * after.position.y;
        }
        real axial = index_after * index_after - (d.x * d.x + d.y * d.y);
        after.steepness = inversesqrt(axial);
        after.direction = real3(d.x, d.y, axial * after.steepness);
    }
    return after;
}

// Newton's method as in meet_surface(), with fewer steps: the second leaves less than a tenth of a micrometre of the
// part that a polynomial adds to its conic, as each error is about the square of the last over the radius. Light that
// has not converged so far is traced in the long form.
#ifdef __cplusplus
const int PLAIN_NEWTON_STEPS = ASPHERE_NEWTON_STEPS;
#else
const int PLAIN_NEWTON_STEPS = 2;
#endif
// Limit of the last step, mm: its square over a radius of 1 mm is a tenth of a micrometre.
const real PLAIN_NEWTON_LAST = real(0.01);

VKFV_FUNCTION ShortTrain pass_asphere_plainly(Surface surface, ShortTrain before, real index_after) {
    real3 d = before.direction;
    real to_plane = (surface.distance - before.position.z) * before.steepness;
    real3 start = real3(before.position.x + to_plane * d.x, before.position.y + to_plane * d.y, real(0.0));
    SurfacePoint conic = meet_conic(start, d, before.index * before.index, surface.curvature, surface.conic);
    bool sound = conic.found;
    real parameter = conic.parameter;
    real3 point = conic.point;
    real slope_over_r = surface.curvature;
    real normal_z = real(1.0) - surface.curvature * (real(1.0) + surface.conic) * point.z;
    int steps = (surface.flags & SURFACE_ASPHERIC) != 0u ? PLAIN_NEWTON_STEPS : 0;
    for (int step = 0; step < steps; ++step) {
        Sag sag = asphere_sag(surface, point.x * point.x + point.y * point.y);
        slope_over_r = sag.slope_over_r;
        normal_z = real(1.0);
        real approach = d.z - slope_over_r * (d.x * point.x + d.y * point.y);
        real further = (sag.sag - point.z) / approach;
        parameter = parameter + further;
        point = real3(start.x + parameter * d.x, start.y + parameter * d.y, parameter * d.z);
        bool near = step == 0 || abs(further * d.z) < PLAIN_NEWTON_LAST;
        sound = sound && sag.defined && approach > real(0.0) && near;
    }
    real nx = slope_over_r * point.x;
    real ny = slope_over_r * point.y;
    real scale = inversesqrt(sound ? nx * nx + ny * ny + normal_z * normal_z : real(-1.0));
    real cosine = scale * (d.z * normal_z - nx * d.x - ny * d.y);
    real cosine_after = sqrt(cosine * cosine + (index_after - before.index) * (index_after + before.index));
    real bend = (cosine_after - cosine) * scale;
    d.x = d.x - bend * nx;
    d.y = d.y - bend * ny;
    real axial = index_after * index_after - (d.x * d.x + d.y * d.y);
    ShortTrain after = before;
    after.position = point;
    after.steepness = inversesqrt(axial);
    after.direction = real3(d.x, d.y, axial * after.steepness);
    after.index = index_after;
    return after;
}

// Passes an asphere by the long form's functions.
VKFV_FUNCTION ShortTrain pass_asphere(Surface surface, ShortTrain before, real index_after) {
    real3 start = real3(before.position.x, before.position.y, before.position.z - surface.distance);
    SurfacePoint meeting = meet_surface(start, before.direction, before.index * before.index, surface);
    Refraction refraction = refract_scaled(before.direction, meeting, before.index, index_after, surface.bend_residual);
    real sound = sqrt(meeting.found && refraction.transmitted ? real(1.0) : real(-1.0));
    ShortTrain after = before;
    after.position = meeting.point * sound;
    after.direction = refraction.direction * sound;
    after.steepness = real(1.0) / after.direction.z;
    after.index = index_after;
    return after;
}

VKFV_FUNCTION ShortTrain pass_surface(Surface surface, ShortTrain before, Light light, uint present, uint form) {
    real index_after = surface.index_after;
    if ((present & FEATURE_SPECTRUM) != 0u) {
        index_after = index_after + disperse(surface.dispersion_after, light.spectral);
    }
    ShortTrain after = pass_sphere(surface, before, index_after, form);
    if ((surface.flags & SURFACE_ASPHERIC) != 0u || surface.conic != real(0.0)) {
        after = form == SHORT_TRAIN_FINE ? pass_asphere(surface, before, index_after)
                                         : pass_asphere_plainly(surface, before, index_after);
    }
    real r_squared = after.position.x * after.position.x + after.position.y * after.position.y;
    after.within =
        before.within && ((surface.flags & SURFACE_CLIPPED) == 0u || r_squared <= surface.semi_diameter_squared);
    after.passed = before.passed + (after.within ? 1 : 0);
    return after;
}

VKFV_FUNCTION ShortTrain enter_short_train(Ray ray, real index) {
    ShortTrain way;
    way.position = ray.position;
    way.direction = ray.direction;
    way.steepness = real(1.0) / ray.direction.z;
    way.index = index;
    way.within = true;
    way.passed = 0;
    return way;
}

// The result of a train passed in the short form. ray: as it entered, since light that has gone astray is traced again
// in the long form.
VKFV_SCENE_FUNCTION VKFV_FUNCTION TrainResult leave_short_train(VKFV_SCENE_PARAMETER int first, int count, Ray ray,
                                                                real index, Light light, ShortTrain way) {
    TrainResult result = enter_train(ray, index);
    result.ray.position = way.position;
    result.ray.direction = way.direction;
    result.index = way.index;
    result.status = way.within ? PATH_ALIVE : PATH_VIGNETTED;
    result.surface = way.within ? -1 : first + way.passed;
    // The test is such that a not-a-number fails it.
    bool sound = abs(way.position.x) + abs(way.position.y) < real(1e30) && abs(way.direction.z) < real(1e30) &&
                 ray.direction.z > real(0.0);
    if (!sound) {
        result = trace_train_by_loop(VKFV_SCENE first, count, ray, index, true, light);
    }
    return result;
}

// trace_short_train() for surfaces that are no constants of the kernel.
VKFV_SCENE_FUNCTION VKFV_FUNCTION TrainResult trace_short_train_by_loop(VKFV_SCENE_PARAMETER int first, int count,
                                                                        Ray ray, real index, Light light, uint form) {
    uint present = features(VKFV_SCENE_ALONE);
    TrainResult result = enter_train(ray, index);
    if ((present & FEATURES_OF_LONG_TRAINS) != 0u) {
        result = trace_train_by_loop(VKFV_SCENE first, count, ray, index, true, light);
    } else {
        ShortTrain way = enter_short_train(ray, index);
        for (int i = first; i < first + count; ++i) {
            way = pass_surface(surface_at(VKFV_SCENE i), way, light, present, form);
        }
        result = leave_short_train(VKFV_SCENE first, count, ray, index, light, way);
    }
    return result;
}

// trace_train() with apertures in the short form; the result's path length and transmittance are not computed.
VKFV_SCENE_FUNCTION VKFV_FUNCTION TrainResult trace_short_train(VKFV_SCENE_PARAMETER int first, int count, Ray ray,
                                                                real index, Light light, uint form) {
#ifdef VKFV_SPECIALISED
    uint present = features(VKFV_SCENE_ALONE);
    TrainResult result = enter_train(ray, index);
    if ((present & FEATURES_OF_LONG_TRAINS) != 0u) {
        result = trace_train(VKFV_SCENE first, count, ray, index, true, light);
    } else {
        ShortTrain way = enter_short_train(ray, index);
#define VKFV_PASS_QUICKLY(k) \
    if (k < known_count) { \
        if (first <= known_first + k && known_first + k < first + count) { \
            Surface surface = surface_at(known_first + k); \
            VKFV_KNOW_SURFACE(k) \
            way = pass_surface(surface, way, light, present, form); \
        } \
    }
        VKFV_EACH_KNOWN_SURFACE(VKFV_PASS_QUICKLY)
        result = leave_short_train(VKFV_SCENE first, count, ray, index, light, way);
    }
    return result;
#else
    return trace_short_train_by_loop(VKFV_SCENE first, count, ray, index, light, form);
#endif
}
