// Traversal of triangles, and of analytic surfaces as procedural boxes, by the tree of bvh.glsl: for devices without
// ray query.
#include "device/specimen_primitives.glsl"
#include "device/bvh.glsl"

// Pairs of type TrianglePair (src/trace/structures/triangle_pairs.hpp), in the order of the tree: twelve numbers, so
// that three loads fetch one.
layout(set = 0, binding = BINDING_VERTICES, scalar) readonly buffer Pairs { vec4 pair_parts[]; };

// Table of type EntryNodes (src/trace/structures/entry_nodes.hpp).
layout(set = 0, binding = BINDING_ENTRY_NODES, scalar) readonly buffer Entries {
    int finest_entries; // level of the finest entries
    uint entry_nodes[];
};

// The rounding of a box's distance is below this multiple of specimen_rounding(): some ten steps of the coordinates.
const real BVH_MARGIN = real(4.0);

// The node of the tree at which the traversal enters; it holds all that the ray may meet. The longer the ray's way
// between bottom and top is across, the further up the node stands; over most surfaces, which are flat, it is short.
// margin: mm, of rounding.
uint entry_node(real3 origin, real3 direction, RayInterval over, real margin) {
    real half_length = real(0.5) * (over.stop - over.start);
    real middle = over.start + half_length;
    real width = specimen.x_max - specimen.x_min;
    real height = specimen.y_max - specimen.y_min;
    real cells =
        min(width / (abs(direction.x) * half_length + margin), height / (abs(direction.y) * half_length + margin));
    int level = findMSB(uint(clamp(cells, real(1.0), real(1 << finest_entries))));
    int side = 1 << level;
    int column = clamp(int((origin.x + middle * direction.x - specimen.x_min) * (real(side) / width)), 0, side - 1);
    int row = clamp(int((origin.y + middle * direction.y - specimen.y_min) * (real(side) / height)), 0, side - 1);
    return entry_nodes[((1 << (2 * level)) - 1) / 3 + row * side + column];
}

BvhWalk specimen_walk(real3 origin, real3 direction, RayInterval over) {
    real reach = max(abs(origin.x), max(abs(origin.y), abs(origin.z)));
    real margin = BVH_MARGIN * (specimen_rounding() + real(4.0) * SURFACE_EPSILON * reach);
    RayInterval ahead = over;
    ahead.start = max(over.start, real(0.0));
    return bvh_walk(entry_node(origin, direction, ahead, margin), origin, direction, ahead.start, margin);
}

struct NearestTriangle {
    bool found;
    real distance;
    uint index; // 2 * pair, plus 1 for the pair's second triangle
    vec2 barycentrics;
};

// Keeps the triangle if it is the nearest so far. u, v, w: edge functions opposite to the corners; depths: of the
// corners along the ray, mm.
void consider_triangle(inout NearestTriangle nearest, real u, real v, real w, real3 depths, uint index, real start) {
    real total = u + v + w;
    bool inside = (min(u, min(v, w)) >= real(0.0) || max(u, max(v, w)) <= real(0.0)) && total != real(0.0);
    real inverse = inside ? real(1.0) / total : real(0.0);
    real distance = (u * depths.x + v * depths.y + w * depths.z) * inverse;
    // At a tie the lower index wins, so that the result does not depend on the order of traversal.
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
    BvhWalk walk = specimen_walk(origin, direction, over);
    NearestTriangle nearest;
    nearest.found = false;
    nearest.distance = over.stop;
    nearest.index = 0u;
    nearest.barycentrics = vec2(0.0, 0.0);
    while (bvh_proceed(walk, nearest.distance)) {
        // All primitives of a node are tested at once, so that lanes diverge less.
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
    BvhWalk walk = specimen_walk(ray.origin, ray.direction, ray.over);
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
