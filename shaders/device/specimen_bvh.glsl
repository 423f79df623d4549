// Triangles, and analytic surfaces as procedural boxes, through the tree of bvh.glsl: for devices without ray query.
#include "device/specimen_primitives.glsl"
#include "device/bvh.glsl"

// The rounding of a box's distance is below this many of specimen_rounding(): some ten steps of the coordinates.
const real BVH_MARGIN = real(4.0);

BvhWalk specimen_walk(real3 origin, real3 direction, real start) {
    real reach = max(abs(origin.x), max(abs(origin.y), abs(origin.z)));
    real margin = BVH_MARGIN * (specimen_rounding() + real(4.0) * SURFACE_EPSILON * reach);
    return bvh_walk(0u, origin, direction, max(start, real(0.0)), margin);
}

// Coordinates of a triangle's corners from the ray's origin: two across the ray, the third along it. As in S. Woop,
// C. Benthin, I. Wald, "Watertight ray/triangle intersection", JCGT 2 (2013) 1, a corner has the same ones in every
// triangle, and the edge functions of neighbours opposite signs on their common edge, since a difference of two rounded
// products may round to zero but never to the wrong sign; zero counts as inside. So no ray passes between the two, as
// long as nothing is contracted: hence `precise`. Instead of a shear along the largest axis, a rotation (T. Duff et
// al., "Building an orthonormal basis, revisited", JCGT 6 (2017) 1).
struct RayFrame {
    real3 origin;
    real3 from_x; // the new coordinates of a unit step along x, y, z
    real3 from_y;
    real3 from_z;
};

RayFrame ray_frame(real3 origin, real3 direction) {
    real side = direction.z >= real(0.0) ? real(1.0) : real(-1.0);
    real a = real(-1.0) / (side + direction.z);
    real b = direction.x * direction.y * a;
    RayFrame frame;
    frame.origin = origin;
    frame.from_x = real3(real(1.0) + side * direction.x * direction.x * a, b, direction.x);
    frame.from_y = real3(side * b, side + direction.y * direction.y * a, direction.y);
    frame.from_z = real3(-side * direction.x, -direction.y, direction.z);
    return frame;
}

real3 in_frame(RayFrame frame, real3 point) {
    precise real3 offset = point - frame.origin;
    precise real3 result = fma(real3(offset.x), frame.from_x,
                               fma(real3(offset.y), frame.from_y, offset.z * frame.from_z));
    return result;
}

Hit meet_triangles(real3 origin, real3 direction, RayInterval over) {
    RayFrame frame = ray_frame(origin, direction);
    BvhWalk walk = specimen_walk(origin, direction, over.start);
    real nearest = over.stop;
    bool found = false;
    uint met = 0u;
    vec2 barycentrics = vec2(0.0, 0.0);
    while (bvh_proceed(walk, nearest)) {
        real3 a = in_frame(frame, triangle_vertex(walk.primitive, 0u));
        real3 b = in_frame(frame, triangle_vertex(walk.primitive, 1u));
        real3 c = in_frame(frame, triangle_vertex(walk.primitive, 2u));
        precise real u = c.x * b.y - c.y * b.x;
        precise real v = a.x * c.y - a.y * c.x;
        precise real w = b.x * a.y - b.y * a.x;
        real total = u + v + w;
        bool inside = (min(u, min(v, w)) >= real(0.0) || max(u, max(v, w)) <= real(0.0)) && total != real(0.0);
        real inverse = inside ? real(1.0) / total : real(0.0);
        real distance = (u * a.z + v * b.z + w * c.z) * inverse;
        // At a tie the first one, in whatever order the tree hands them out.
        bool nearer = distance < nearest || (distance == nearest && (!found || walk.primitive < met));
        if (inside && nearer && distance > max(over.start, real(0.0))) {
            found = true;
            nearest = distance;
            met = walk.primitive;
            barycentrics = vec2(v, w) * inverse;
        }
    }
    Hit hit = no_hit();
    if (found) {
        hit = triangle_hit(met, barycentrics, nearest, direction);
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
