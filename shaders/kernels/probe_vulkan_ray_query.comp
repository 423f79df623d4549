// Finds the nearest hits of given rays with triangles, and with spheres that fill the boxes of a procedural geometry.
#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_scalar_block_layout : require

layout(local_size_x = 64) in;

struct Ray {
    vec3 origin;
    float t_min;
    vec3 direction; // unit
    float t_max;
};
struct Sphere {
    vec3 centre;
    float radius;
};
struct Hit {
    float t; // negative: no hit
    uint primitive;
    uint candidates; // boxes that the traversal offered
};

layout(push_constant, scalar) uniform Push {
    uint count;
    uint flags; // flags of the ray query
}
push;

layout(set = 0, binding = 0) uniform accelerationStructureEXT structure;
layout(set = 0, binding = 1, scalar) readonly buffer Rays { Ray rays[]; };
layout(set = 0, binding = 2, scalar) readonly buffer Spheres { Sphere spheres[]; };
layout(set = 0, binding = 3, scalar) writeonly buffer Hits { Hit hits[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) {
        return;
    }
    Ray ray = rays[i];
    Hit hit = Hit(-1.0, 0u, 0u);
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure, push.flags, 0xFFu, ray.origin, ray.t_min, ray.direction, ray.t_max);
    float nearest = ray.t_max;
    while (rayQueryProceedEXT(query)) {
        ++hit.candidates;
        Sphere sphere = spheres[rayQueryGetIntersectionPrimitiveIndexEXT(query, false)];
        // The root is taken from the foot of the perpendicular: a difference of large squares would cost half the
        // digits.
        vec3 to_centre = sphere.centre - ray.origin;
        float along = dot(to_centre, ray.direction);
        vec3 aside = to_centre - along * ray.direction;
        float half_chord_squared = sphere.radius * sphere.radius - dot(aside, aside);
        if (half_chord_squared >= 0.0) {
            float t = along - sqrt(half_chord_squared);
            if (t >= ray.t_min && t <= nearest) {
                nearest = t;
                rayQueryGenerateIntersectionEXT(query, t);
            }
        }
    }
    if (rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT) {
        hit.t = rayQueryGetIntersectionTEXT(query, true);
        hit.primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    }
    hits[i] = hit;
}
