// Traversal of triangles, and of analytic surfaces as procedural boxes, by VK_KHR_ray_query.
#include "device/specimen_primitives.glsl"
#include "device/specimen_structure.glsl"

// Instance masks: bit k is of the k-th part that AccelerationStructure::join joined in.
const uint SPECIMEN_MASK = 1u;
const uint ELEMENT_MASK = 2u; // the instrument's elements, for non-sequential paths

Hit meet_triangles(real3 origin, real3 direction, RayInterval over) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, specimen_structure, gl_RayFlagsOpaqueEXT, SPECIMEN_MASK, origin,
                          max(over.start, real(0.0)), direction, over.stop);
    while (rayQueryProceedEXT(query)) {
    }
    Hit hit = no_hit();
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT) {
        uint triangle = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
        hit = triangle_hit(triangle_vertex(triangle, 0u), triangle_vertex(triangle, 1u), triangle_vertex(triangle, 2u),
                           rayQueryGetIntersectionBarycentricsEXT(query, true),
                           rayQueryGetIntersectionTEXT(query, true), direction);
    }
    return hit;
}

Hit meet_tiles(SpecimenRay ray, real rounding) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, specimen_structure, gl_RayFlagsNoneEXT, SPECIMEN_MASK, ray.origin,
                          max(ray.over.start, real(0.0)), ray.direction, ray.over.stop);
    Hit hit = no_hit();
    hit.distance = ray.over.stop;
    while (rayQueryProceedEXT(query)) {
        Hit candidate = tile_hit(tiles[rayQueryGetIntersectionPrimitiveIndexEXT(query, false)], ray, rounding);
        // A march knows nothing of the meetings in other boxes, so only a nearer one counts.
        if (candidate.found == 1u && candidate.distance < hit.distance) {
            hit = candidate;
            rayQueryGenerateIntersectionEXT(query, candidate.distance);
        }
    }
    return hit;
}
