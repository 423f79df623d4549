// The interface of all traversals: Hit specimen_hit(origin, direction), the nearest meeting of a ray with the specimen
// (specimen frame, mm, unit direction). The kernel's defines choose the traversal, and the constant specimen_kind the
// kind of specimen, so that a pipeline holds one way only.
//
// A height field separates above from below. A ray that starts over the footprint, or comes through its top, is above
// and is met where it first gets below; one that starts below by rounding is met at once only where it does not come
// out within its first facet. A ray that comes in through a side of the footprint may be below, and is then met from
// below. Nothing of this holds for meshes, which are met from any side.
layout(constant_id = CONSTANT_SPECIMEN_KIND) const uint specimen_kind = SPECIMEN_FACETS;

layout(set = 0, binding = BINDING_HEIGHTS, scalar) readonly buffer Heights { real heights[]; }; // row 0 at the lowest y

real lattice_at(int column, int row) { return heights[row * specimen.columns + column]; }

// Factors by rows, in the order of the heights' rows.
layout(set = 0, binding = BINDING_REFLECTANCES, scalar) readonly buffer Reflectances { real reflectances[]; };

layout(set = 0, binding = BINDING_MATERIAL, scalar) readonly buffer MaterialNumbers { real material_numbers[]; };

real material_number(int index) { return material_numbers[index]; }

layout(set = 0, binding = BINDING_LIGHT_POINTS, scalar) readonly buffer LightPoints { real light_points[]; };

real pattern_point(Pattern pattern, int column, int row) {
    int place = row * pattern.columns + column;
    return pattern.of_light != 0u ? light_points[place] : reflectances[place];
}

// A ray clipped to the specimen's bounds. Its origin is moved there, as the error of a distance grows with the
// distance.
struct SpecimenRay {
    real3 origin;
    real3 direction;
    real advance;     // distance along the given ray at the new origin; may be slightly negative
    RayInterval over; // mm, from the new origin: over the footprint and between bottom and top; empty: no meeting
    bool beside;      // the ray comes in through a side of the footprint
    bool through;     // the ray goes down through the bottom: a surface without holes must have met it
};

// Bounds the rounding of a point on a ray near the specimen: four steps (2^-23) of the largest coordinate.
real specimen_rounding() {
    real across = max(max(abs(specimen.x_min), abs(specimen.x_max)), max(abs(specimen.y_min), abs(specimen.y_max)));
    return real(4.0) * SURFACE_EPSILON * max(across, max(abs(specimen.bottom), abs(specimen.top)));
}

// Clips a ray to the specimen's box. rounding, widening: mm, by which the box grows along z and on each side of the
// footprint.
SpecimenRay cut_to_specimen(real3 origin, real3 direction, real rounding, real widening) {
    real upper = specimen.top + rounding;
    real lower = specimen.bottom - rounding;
    bool down = direction.z < real(0.0);
    SpecimenRay ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.advance = real(0.0);
    if (down && origin.z >= specimen.top) {
        ray.advance = (upper - origin.z) / direction.z;
        ray.origin = real3(origin.x + ray.advance * direction.x, origin.y + ray.advance * direction.y, upper);
    }
    // A horizontal ray ends at a side of the footprint.
    real to_end = direction.z != real(0.0) ? ((down ? lower : upper) - ray.origin.z) / direction.z : real(1e30);
    ray.over.start = real(0.0);
    ray.over.stop = to_end;
    ray.over = clip_interval(ray.over, ray.origin.x, direction.x, specimen.x_min - widening, specimen.x_max + widening);
    ray.over = clip_interval(ray.over, ray.origin.y, direction.y, specimen.y_min - widening, specimen.y_max + widening);
    ray.beside = ray.over.start > real(0.0);
    ray.through = down && ray.over.stop == to_end && ray.over.start == real(0.0);
    return ray;
}

Hit no_hit() {
    Hit hit;
    hit.found = 0u;
    hit.distance = real(0.0);
    hit.position = real3(real(0.0), real(0.0), real(0.0));
    hit.normal = real3(real(0.0), real(0.0), real(1.0));
    return hit;
}

#ifdef VKFV_RAY_QUERY
#include "device/specimen_ray_query.glsl"
#elif defined(VKFV_RAY_PIPELINE)
#include "device/specimen_ray_pipeline.glsl"
#elif defined(VKFV_BVH)
#include "device/specimen_bvh.glsl"
#else
#include "device/specimen_quadtree.glsl"
#endif
