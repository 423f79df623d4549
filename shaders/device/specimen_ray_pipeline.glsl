// Traversal of triangles, and of analytic surfaces as procedural boxes, by VK_KHR_ray_tracing_pipeline: for the probe
// of acceleration structures on GPUs that have no ray query. Its generation stage calls specimen_hit(); the stages at a
// primitive compute that primitive's hit alone.
#include "device/specimen_primitives.glsl"
#include "device/specimen_structure.glsl"

#ifndef VKFV_AT_A_PRIMITIVE
layout(location = 0) rayPayloadEXT Hit met;

Hit meet_structure(real3 origin, real3 direction, RayInterval over) {
    met = no_hit();
    traceRayEXT(specimen_structure, gl_RayFlagsOpaqueEXT, 0xFFu, 0u, 0u, 0u, origin, max(over.start, real(0.0)),
                direction, over.stop, 0);
    return met;
}

Hit meet_triangles(real3 origin, real3 direction, RayInterval over) { return meet_structure(origin, direction, over); }

Hit meet_tiles(SpecimenRay ray, real rounding) { return meet_structure(ray.origin, ray.direction, ray.over); }
#else
// The hit of a ray with one tile. The ray starts where the generation stage has clipped it to the specimen, so that
// clipping it once more changes nothing.
Hit hit_of_tile(uint tile, real3 origin, real3 direction) {
    real rounding = specimen_rounding();
    return tile_hit(tiles[tile], cut_to_specimen(origin, direction, rounding, rounding), rounding);
}
#endif
