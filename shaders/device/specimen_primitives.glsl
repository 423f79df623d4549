// Functions common to the traversals of trees of primitives: triangles, analytic surfaces as procedural boxes (tiles),
// and the repeated test of a ray that slips through. Each traversal itself defines
//
//     Hit meet_triangles(real3 origin, real3 direction, RayInterval over)  the nearest one, from either side
//     Hit meet_tiles(SpecimenRay ray, real rounding)

struct SurfaceTile {
    real3 lower; // lower corner of its box, mm, as the tree's builder had it
    real3 upper;
};
layout(set = 0, binding = BINDING_TILES, scalar) readonly buffer Tiles { SurfaceTile tiles[]; };

// A ray aimed at an edge may slip between its triangles: it is tried again beside itself by this many roundings.
const int PRIMITIVE_TRIES = 4;

// Position and normal from the barycentrics of the second and third corner: the position is on the facet, however far
// the ray came.
Hit triangle_hit(real3 corner, real3 second, real3 third, vec2 barycentrics, real distance, real3 direction) {
    real3 edge_1 = second - corner;
    real3 edge_2 = third - corner;
    real3 normal = normalize(cross(edge_1, edge_2));
    bool turn = specimen_kind == SPECIMEN_MESH ? dot(normal, direction) > real(0.0) : normal.z < real(0.0);
    Hit hit;
    hit.found = 1u;
    hit.distance = distance;
    hit.position = corner + barycentrics.x * edge_1 + barycentrics.y * edge_2;
    hit.normal = turn ? -normal : normal;
    return hit;
}

// The meeting of the ray with the surface within one tile, or none.
Hit tile_hit(SurfaceTile tile, SpecimenRay ray, real rounding) {
    RayInterval inside = ray.over;
    inside = clip_interval(inside, ray.origin.x, ray.direction.x, tile.lower.x - rounding, tile.upper.x + rounding);
    inside = clip_interval(inside, ray.origin.y, ray.direction.y, tile.lower.y - rounding, tile.upper.y + rounding);
    // A ray from beside may be below the surface, so the march covers all of the ray to know its side.
    inside.start = ray.beside ? real(0.0) : inside.start;
    inside.stop = ray.beside ? ray.over.stop : inside.stop;
    Hit hit = march_surface(specimen, ray.origin, ray.direction, inside.start, inside.stop);
    // The box may lie before the ray's start.
    hit.found = inside.start <= inside.stop ? hit.found : 0u;
    return hit;
}

#ifndef VKFV_AT_A_PRIMITIVE // any shader but those that are called for one primitive
Hit meet_triangles(real3 origin, real3 direction, RayInterval over);
Hit meet_tiles(SpecimenRay ray, real rounding);

Hit specimen_hit(real3 origin, real3 direction) {
    real rounding = specimen_rounding();
    SpecimenRay ray = cut_to_specimen(origin, direction, rounding, rounding);
    Hit hit = no_hit();
    if (ray.over.start <= ray.over.stop) {
        if (specimen_kind == SPECIMEN_ANALYTIC) {
            hit = meet_tiles(ray, rounding);
        } else {
            // A ray that is above a height field cannot meet it from below, unless it starts there by rounding.
            bool above = specimen_kind == SPECIMEN_FACETS && !ray.beside;
            real aside = real(0.0);
            bool open = true;
            for (int i = 0; i < PRIMITIVE_TRIES && open; ++i) {
                // The shift is askew to rows, columns and diagonals, and points back over the footprint at its border.
                real3 nudge = real3(ray.origin.x > real(0.0) ? -aside : aside,
                                    ray.origin.y > real(0.0) ? real(-0.6) * aside : real(0.6) * aside, real(0.0));
                hit = meet_triangles(ray.origin + nudge, direction, ray.over);
                bool from_below = hit.found == 1u && above && dot(hit.normal, direction) > real(0.0);
                open = from_below || (hit.found == 0u && ray.through);
                ray.over.start = from_below ? hit.distance : ray.over.start;
                aside = from_below ? aside : aside + rounding;
                hit.found = from_below ? 0u : hit.found;
            }
        }
    }
    hit.distance = max(hit.distance + ray.advance, real(0.0));
    return hit;
}
#endif
