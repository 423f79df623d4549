// A train of surfaces, traced in sequence, each in the frame of its own vertex.

struct TrainResult {
    Ray ray;          // in the frame of the last surface met, after it
    real index;       // index of the medium that the ray is in
    real transmitted; // product of the surfaces' transmittances
    uint status;      // PATH_ALIVE, or why the path ended
    int surface;      // the surface where it ended, else -1
};

#ifdef __cplusplus
template <class Scene>
Surface surface_at(const Scene& scene, int index) {
    return scene.surface_at(index);
}
#else
Surface surface_at(int index); // the kernel's bindings say where surfaces are kept
#endif

VKFV_FUNCTION real3 to_surface_frame(Surface surface, real3 v) {
    return real3(surface.rotation_xx * v.x + surface.rotation_xy * v.y + surface.rotation_xz * v.z,
                 surface.rotation_yx * v.x + surface.rotation_yy * v.y + surface.rotation_yz * v.z,
                 surface.rotation_zx * v.x + surface.rotation_zy * v.y + surface.rotation_zz * v.z);
}

// The share of light that a surface lets pass, for light that its shape does not stop.
VKFV_FUNCTION real surface_transmittance(Surface surface, real cosine, real index_before, real index_after,
                                         real wave_number) {
    return (surface.flags & SURFACE_MIRROR) != 0u
               ? surface.reflectance
               : real(1.0) -
                     interface_reflectance(surface, index_before, index_after, min(cosine, real(1.0)), wave_number);
}

// Light through one surface: transfer, intersection, edge, refraction. `before` is in the frame of the previous vertex.
// A plane mirror leaves the light's way unchanged: all that follows stands in the space that the mirror shows. Light
// that has ended keeps its status, and its ray continues without meaning: to hold it would cost every ray.
VKFV_FUNCTION TrainResult trace_surface(Surface surface, int index, TrainResult before, bool apertures, Light light,
                                        uint present) {
    real3 start = real3(before.ray.position.x, before.ray.position.y, before.ray.position.z - surface.distance);
    real3 direction = before.ray.direction;
    if ((present & FEATURE_PLACEMENT) != 0u) {
        start.x = start.x - surface.decentre_x;
        start.y = start.y - surface.decentre_y;
        start = to_surface_frame(surface, start);
        direction = to_surface_frame(surface, direction);
    }
    real index_before = before.index;
    real index_after = surface.index_after;
    if ((present & FEATURE_SPECTRUM) != 0u) {
        index_after = index_after + disperse(surface.dispersion_after, light.spectral);
    }
    SurfacePoint meeting = meet_surface(start, direction, index_before * index_before, surface);
    real3 point = meeting.point;
    Refraction refraction = refract_scaled(direction, meeting, index_before, index_after, surface.bend_residual);
    bool clipped = apertures && (surface.flags & SURFACE_CLIPPED) != 0u &&
                   point.x * point.x + point.y * point.y > surface.semi_diameter_squared;
    TrainResult result = before;
    result.ray.position = point;
    result.ray.direction = refraction.direction;
    // The direction has length n, so the geometric way is parameter * n and the optical path parameter * n^2.
    result.ray.path_length = before.ray.path_length + meeting.parameter * index_before * index_before;
    result.index = index_after;
    bool found = direction.z > real(0.0) && meeting.found;
    bool passes = refraction.transmitted;
    if (SURFACE_IS_KNOWN && (present & FEATURE_SPECTRUM) == 0u && index_before == index_after) { // a stop
        result.ray.direction = direction;
        passes = true;
    }
    if ((present & FEATURE_IDEAL_LENS) != 0u && (surface.flags & SURFACE_IDEAL_LENS) != 0u) {
        IdealLens lens = pass_ideal_lens(start, direction, surface.power, index_before, index_after);
        result.ray.position = lens.position;
        result.ray.direction = lens.direction;
        result.ray.path_length = before.ray.path_length + lens.path_length;
        passes = lens.passes;
    }
    bool lost = false;
    if ((present & FEATURE_LOSSES) != 0u) {
        result.transmitted = before.transmitted * surface_transmittance(surface, meeting.cosine / index_before,
                                                                        index_before, index_after, light.wave_number);
        lost = result.transmitted < light.survival;
    }
    if (before.status == PATH_ALIVE && !(found && !clipped && passes && !lost)) {
        result.status = !found    ? PATH_MISSED_SURFACE
                        : clipped ? PATH_VIGNETTED
                        : !passes ? PATH_TOTAL_REFLECTION
                                  : PATH_INTERFACE_LOSS;
        result.surface = index;
    }
    return result;
}

// The result behind a surface, with the share of light taken off that a pattern there does not let through.
VKFV_SCENE_FUNCTION VKFV_FUNCTION TrainResult pass_light_field(VKFV_SCENE_PARAMETER Surface surface, int index,
                                                               TrainResult behind, Light light) {
    TrainResult result = behind;
    if ((features(VKFV_SCENE_ALONE) & FEATURE_LIGHT_FIELD) != 0u) {
        real share = light_field_at(VKFV_SCENE surface, behind.ray.position.x, behind.ray.position.y);
        result.transmitted = behind.transmitted * share;
        if (behind.status == PATH_ALIVE && result.transmitted < light.survival) {
            result.status = PATH_INTERFACE_LOSS;
            result.surface = index;
        }
    }
    return result;
}

// The state of a ray that enters a train, in the frame of the first vertex (its z there, usually negative), its
// direction scaled by `index`, that of the medium in front of the train. Every ray goes through the train to its end:
// neighbouring rays seldom all end, and a loop that all leave together reads each surface once for all of them.
VKFV_FUNCTION TrainResult enter_train(Ray ray, real index) {
    TrainResult result;
    result.ray = ray;
    result.index = index;
    result.transmitted = real(1.0);
    result.status = PATH_ALIVE;
    result.surface = -1;
    return result;
}

// Traces a train by a loop, even where the kernel has the instrument as constants: few rays need it, and its code is
// short.
VKFV_SCENE_FUNCTION VKFV_FUNCTION TrainResult trace_train_by_loop(VKFV_SCENE_PARAMETER int first, int count, Ray ray,
                                                                  real index, bool apertures, Light light) {
    TrainResult result = enter_train(ray, index);
    for (int i = first; i < first + count; ++i) {
        Surface surface = surface_at(VKFV_SCENE i);
        result = trace_surface(surface, i, result, apertures, light, features(VKFV_SCENE_ALONE));
        result = pass_light_field(VKFV_SCENE surface, i, result, light);
    }
    return result;
}

VKFV_SCENE_FUNCTION VKFV_FUNCTION TrainResult trace_train(VKFV_SCENE_PARAMETER int first, int count, Ray ray,
                                                          real index, bool apertures, Light light) {
#ifdef VKFV_SPECIALISED
    TrainResult result = enter_train(ray, index);
    // The surfaces are written out, as constants fold only where each surface has a place of its own
    // (device/prescription.glsl). The outer test is of constants alone: surfaces that fail it cost a driver little time
    // to compile.
#define VKFV_PASS_SURFACE(k) \
    if (k < known_count) { \
        if (first <= known_first + k && known_first + k < first + count) { \
            Surface surface = surface_at(known_first + k); \
            VKFV_KNOW_SURFACE(k) \
            result = trace_surface(surface, known_first + k, result, apertures, light, features()); \
            result = pass_light_field(surface, known_first + k, result, light); \
        } \
    }
    VKFV_EACH_KNOWN_SURFACE(VKFV_PASS_SURFACE)
    return result;
#else
    return trace_train_by_loop(VKFV_SCENE first, count, ray, index, apertures, light);
#endif
}

// Free flight to the plane z = plane (same frame) in a medium of the given index; z becomes 0 there. plane: mm.
VKFV_FUNCTION Ray fly_to_plane(Ray ray, real plane, real index) {
    real parameter = (plane - ray.position.z) / ray.direction.z;
    Ray result;
    result.position =
        real3(ray.position.x + parameter * ray.direction.x, ray.position.y + parameter * ray.direction.y, real(0.0));
    result.direction = ray.direction;
    result.path_length = ray.path_length + parameter * index * index;
    return result;
}
