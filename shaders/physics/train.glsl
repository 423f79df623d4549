// A train of surfaces, traced in sequence: each in the frame of its own vertex.

struct TrainResult {
    Ray ray;          // in the frame of the last surface met, after it
    real index;       // of the medium it is in
    real transmitted; // product of the surfaces' transmittances
    uint status;      // PATH_ALIVE or why it ended
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

// The share that a surface lets pass on, of light that its shape does not stop.
VKFV_FUNCTION real surface_transmittance(Surface surface, real cosine, real index_before, real index_after,
                                         real wave_number) {
    return (surface.flags & SURFACE_MIRROR) != 0u
               ? surface.reflectance
               : real(1.0) - interface_reflectance(surface, index_before, index_after, min(cosine, real(1.0)),
                                                   wave_number);
}

// One surface: transfer, intersection, edge, refraction. `before` is in the frame of the previous vertex. A plane mirror
// leaves the light's way as it was: all that follows it stands in the space that the mirror shows.
VKFV_FUNCTION TrainResult trace_surface(Surface surface, int index, TrainResult before, uint apertures, Light light,
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
    Refraction refraction =
        refract_scaled(direction, meeting, index_before, index_after, surface.bend_residual);
    bool clipped = apertures != 0u && (surface.flags & SURFACE_CLIPPED) != 0u &&
                   point.x * point.x + point.y * point.y > surface.semi_diameter_squared;
    TrainResult result;
    result.ray.position = point;
    result.ray.direction = refraction.direction;
    // The direction has length n, so the geometric way is parameter * n and the optical path parameter * n^2.
    result.ray.path_length = before.ray.path_length + meeting.parameter * index_before * index_before;
    result.index = index_after;
    result.transmitted = before.transmitted;
    uint found = direction.z > real(0.0) ? meeting.found : 0u;
    uint passes = refraction.transmitted;
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
                                                                        index_before, index_after,
                                                                        light.wave_number);
        lost = result.transmitted < light.survival;
    }
    result.status = found == 0u    ? PATH_MISSED_SURFACE
                    : clipped      ? PATH_VIGNETTED
                    : passes == 0u ? PATH_TOTAL_REFLECTION
                    : lost         ? PATH_INTERFACE_LOSS
                                   : PATH_ALIVE;
    result.surface = result.status == PATH_ALIVE ? -1 : index;
    return result;
}

// ray enters in the frame of the first vertex (its z there, usually negative), its direction scaled by `index`, that of the
// medium in front of the train. The loop runs to its end for every ray: an ended one keeps its state. Neighbouring rays
// seldom all end, and a loop that all leave together reads each surface once for all of them.
VKFV_SCENE_FUNCTION VKFV_FUNCTION TrainResult trace_train(VKFV_SCENE_PARAMETER int first, int count, Ray ray,
                                                          real index, uint apertures, Light light) {
    TrainResult result;
    result.ray = ray;
    result.index = index;
    result.transmitted = real(1.0);
    result.status = PATH_ALIVE;
    result.surface = -1;
    for (int i = 0; i < count; ++i) {
        TrainResult next = trace_surface(surface_at(VKFV_SCENE first + i), first + i, result, apertures, light,
                                         features(VKFV_SCENE_ALONE));
        if (result.status == PATH_ALIVE) {
            result = next;
        }
    }
    return result;
}

// Free flight to the plane z = plane (same frame), in a medium of the given index; z becomes 0 there.
VKFV_FUNCTION Ray fly_to_plane(Ray ray, real plane, real index) {
    real parameter = (plane - ray.position.z) / ray.direction.z;
    Ray result;
    result.position = real3(ray.position.x + parameter * ray.direction.x,
                            ray.position.y + parameter * ray.direction.y, real(0.0));
    result.direction = ray.direction;
    result.path_length = ray.path_length + parameter * index * index;
    return result;
}
