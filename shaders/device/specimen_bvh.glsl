// Triangles, and analytic surfaces as procedural boxes, through the tree of bvh.glsl: for devices without ray query.
#include "device/specimen_primitives.glsl"
#include "device/bvh.glsl"

// TrianglePair of src/trace/triangle_pairs.hpp, in the order of the tree: twelve numbers, so that three loads fetch
// them.
layout(set = 0, binding = BINDING_VERTICES, scalar) readonly buffer Pairs { vec4 pair_parts[]; };

// The rounding of a box's distance is below this many of specimen_rounding(): some ten steps of the coordinates.
const real BVH_MARGIN = real(4.0);

BvhWalk specimen_walk(real3 origin, real3 direction, real start) {
    real reach = max(abs(origin.x), max(abs(origin.y), abs(origin.z)));
    real margin = BVH_MARGIN * (specimen_rounding() + real(4.0) * SURFACE_EPSILON * reach);
    return bvh_walk(0u, origin, direction, max(start, real(0.0)), margin);
}

struct NearestTriangle {
    bool found;
    real distance;
    uint index; // twice its pair's, plus 1 for the second
    vec2 barycentrics;
};

// u, v, w: edge functions opposite to the corners, whose depths are given.
void consider_triangle(inout NearestTriangle nearest, real u, real v, real w, real3 depths, uint index, real start) {
    real total = u + v + w;
    bool inside = (min(u, min(v, w)) >= real(0.0) || max(u, max(v, w)) <= real(0.0)) && total != real(0.0);
    real inverse = inside ? real(1.0) / total : real(0.0);
    real distance = (u * depths.x + v * depths.y + w * depths.z) * inverse;
    // At a tie the first one, in whatever order the tree hands them out.
    bool nearer =
        distance < nearest.distance || (distance == nearest.distance && (!nearest.found || index < nearest.index));
    bool taken = inside && nearer && distance > start;
    nearest.found = nearest.found || taken;
    nearest.distance = taken ? distance : nearest.distance;
    nearest.index = taken ? index : nearest.index;
    nearest.barycentrics = taken ? vec2(v, w) * inverse : nearest.barycentrics;
}

Hit meet_triangles(real3 origin, real3 direction, RayInterval over) {
    RayFrame frame = ray_frame(origin, direction);
    BvhWalk walk = specimen_walk(origin, direction, over.start);
    NearestTriangle nearest;
    nearest.found = false;
    nearest.distance = over.stop;
    nearest.index = 0u;
    nearest.barycentrics = vec2(0.0, 0.0);
    while (bvh_proceed(walk, nearest.distance)) {
        // All of a node's at once: lanes part less than if each went on for itself.
        bool another = true;
        while (another) {
            vec4 part_0 = pair_parts[3u * walk.primitive];
            vec4 part_1 = pair_parts[3u * walk.primitive + 1u];
            vec4 part_2 = pair_parts[3u * walk.primitive + 2u];
            real3 a = in_frame(frame, part_0.xyz);
            real3 b = in_frame(frame, real3(part_0.w, part_1.xy));
            real3 c = in_frame(frame, real3(part_1.zw, part_2.x));
            real3 d = in_frame(frame, part_2.yzw);
            precise real bc = c.x * b.y - c.y * b.x;
            precise real ca = a.x * c.y - a.y * c.x;
            precise real ab = b.x * a.y - b.y * a.x;
            precise real cd = d.x * c.y - d.y * c.x;
            precise real da = a.x * d.y - a.y * d.x;
            consider_triangle(nearest, bc, ca, ab, real3(a.z, b.z, c.z), 2u * walk.primitive, walk.start);
            consider_triangle(nearest, cd, da, -ca, real3(a.z, c.z, d.z), 2u * walk.primitive + 1u, walk.start);
            another = bvh_another(walk);
        }
    }
    Hit hit = no_hit();
    if (nearest.found) {
        uint first = 3u * (nearest.index >> 1);
        bool in_second = (nearest.index & 1u) == 1u;
        vec4 part_0 = pair_parts[first];
        vec4 part_1 = pair_parts[first + 1u];
        vec4 part_2 = pair_parts[first + 2u];
        real3 b = real3(part_0.w, part_1.xy);
        real3 c = real3(part_1.zw, part_2.x);
        real3 d = part_2.yzw;
        hit = triangle_hit(part_0.xyz, in_second ? c : b, in_second ? d : c, nearest.barycentrics, nearest.distance,
                           direction);
    }
    return hit;
}

Hit meet_tiles(SpecimenRay ray, real rounding) {
    BvhWalk walk = specimen_walk(ray.origin, ray.direction, ray.over.start);
    Hit hit = no_hit();
    hit.distance = ray.over.stop;
    while (bvh_proceed(walk, hit.distance)) {
        Hit candidate = tile_hit(tiles[walk.primitive], ray, rounding);
        if (candidate.found == 1u && candidate.distance < hit.distance) {
            hit = candidate;
        }
    }
    return hit;
}
