// A train of surfaces, traced in sequence: each in the frame of its own vertex.

struct TrainResult {
    Ray ray;     // in the frame of the last surface met, after it
    uint status; // PATH_ALIVE or why it ended
    int surface; // the surface where it ended, else -1
};

#ifdef __cplusplus
template <class Scene>
Surface surface_at(const Scene& scene, int index) {
    return scene.surface_at(index);
}
#else
Surface surface_at(int index); // the kernel's bindings say where surfaces are kept
#endif

// One surface: transfer, intersection, edge, refraction. ray enters in the frame of the previous vertex.
VKFV_FUNCTION TrainResult trace_surface(Surface surface, int index, Ray ray, uint apertures) {
    real3 start = real3(ray.position.x, ray.position.y, ray.position.z - surface.distance);
    SurfacePoint meeting = meet_surface(start, ray.direction, surface);
    real3 point = start + meeting.parameter * ray.direction;
    Refraction refraction =
        refract_scaled(ray.direction, meeting.normal, surface.index_before, surface.index_after);
    bool clipped = apertures != 0u && (surface.flags & SURFACE_CLIPPED) != 0u &&
                   point.x * point.x + point.y * point.y > surface.semi_diameter_squared;
    TrainResult result;
    result.ray.position = point;
    result.ray.direction = refraction.direction;
    // The direction has length n, so the geometric way is parameter * n and the optical path parameter * n^2.
    result.ray.path_length = ray.path_length +
                             meeting.parameter * surface.index_before * surface.index_before;
    result.status = meeting.found == 0u        ? PATH_MISSED_SURFACE
                    : clipped                  ? PATH_VIGNETTED
                    : refraction.transmitted == 0u ? PATH_TOTAL_REFLECTION
                                               : PATH_ALIVE;
    result.surface = result.status == PATH_ALIVE ? -1 : index;
    return result;
}

// ray enters in the frame of the first vertex (its z there, usually negative). The loop runs to its end for every ray: an
// ended one keeps its state. Neighbouring rays seldom all end, and a loop that all leave together reads each surface once
// for all of them.
VKFV_SCENE_FUNCTION VKFV_FUNCTION TrainResult trace_train(VKFV_SCENE_PARAMETER int first, int count, Ray ray,
                                                          uint apertures) {
    TrainResult result;
    result.ray = ray;
    result.status = PATH_ALIVE;
    result.surface = -1;
    for (int i = 0; i < count; ++i) {
        TrainResult next = trace_surface(surface_at(VKFV_SCENE first + i), first + i, result.ray, apertures);
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
