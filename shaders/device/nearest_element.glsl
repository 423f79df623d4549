// nearest_element() of physics/nonsequential.glsl: the instrument's elements, and the facets of meshes, as procedural
// boxes in the structure that also holds the specimen. Elements and specimen have different frames, since they move
// against each other from image to image, so each is traversed by itself.
layout(set = 0, binding = BINDING_ELEMENTS, scalar) readonly buffer Elements { Element elements[]; };
layout(set = 0, binding = BINDING_ELEMENT_ORDER, scalar) readonly buffer ElementOrder {
    uint element_order[];
}; // by box: an element's index, or with FACET_BIT a facet's
layout(set = 0, binding = BINDING_FACETS, scalar) readonly buffer Facets { Facet facets[]; };

Element element_at(int index) { return elements[index]; }
Facet facet_at(int index) { return facets[index]; }

// mm, larger than any instrument.
const real FARTHEST = real(1e6);

// Tests the element or facet in the box at this place of the order; returns the nearer of it and `nearest`.
NearestElement consider_box(NearestElement nearest, uint place, RayFrame frame, real3 direction, PathPlace from,
                            real least) {
    uint held = element_order[place];
    if ((features() & FEATURE_FACETS) != 0u && (held & FACET_BIT) != 0u) {
        int facet = int(held & ~FACET_BIT);
        nearest = consider_facet(nearest, frame, facets[facet], facet, from, least);
    } else {
        int index = int(held);
        ElementMeeting meeting = meet_element(elements[index], frame.origin, direction, index == from.element, least);
        if (meeting.found && meeting.distance < nearest.hit.distance) {
            nearest.hit.index = index;
            nearest.hit.facet = -1;
            nearest.hit.distance = meeting.distance;
        }
    }
    return nearest;
}

ElementHit nearest_element(real3 origin, real3 direction, PathPlace from) {
    real least = least_distance(origin);
    RayFrame frame = ray_frame(origin, direction);
    NearestElement nearest = no_element(FARTHEST);
#ifdef VKFV_RAY_QUERY
    rayQueryEXT query;
    rayQueryInitializeEXT(query, specimen_structure, gl_RayFlagsNoneEXT, ELEMENT_MASK, origin, real(0.0), direction,
                          FARTHEST);
    while (rayQueryProceedEXT(query)) {
        real farthest = nearest.hit.distance;
        nearest = consider_box(nearest, uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false)), frame, direction,
                               from, least);
        if (nearest.hit.distance < farthest) {
            rayQueryGenerateIntersectionEXT(query, nearest.hit.distance);
        }
    }
#else
    // The margin is for coordinates of up to 1 m, which boxes of an instrument may have though the origin's are small.
    real reach = max(max(abs(origin.x), abs(origin.y)), max(abs(origin.z), real(1e3)));
    BvhWalk walk = bvh_walk(batch.elements_root, origin, direction, real(0.0), real(16.0) * SURFACE_EPSILON * reach);
    while (bvh_proceed(walk, nearest.hit.distance)) {
        nearest = consider_box(nearest, walk.primitive, frame, direction, from, least);
    }
#endif
    return nearest_hit(nearest, from);
}
