// The instrument's elements as procedural boxes, in the structure that holds the specimen too: nearest_element() of
// physics/nonsequential.glsl. Elements and specimen stand in frames of their own (they move against each other from
// image to image), so each is asked for by itself.
layout(set = 0, binding = BINDING_ELEMENTS, scalar) readonly buffer Elements { Element elements[]; };
layout(set = 0, binding = BINDING_ELEMENT_ORDER, scalar) readonly buffer ElementOrder {
    uint element_order[];
}; // of the boxes

Element element_at(int index) { return elements[index]; }

// mm: no instrument is larger.
const real FARTHEST = real(1e6);

#ifdef VKFV_RAY_QUERY
ElementHit nearest_element(real3 origin, real3 direction, int left) {
    real least = least_distance(origin);
    ElementHit nearest;
    nearest.index = -1;
    nearest.distance = FARTHEST;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, specimen_structure, gl_RayFlagsNoneEXT, ELEMENT_MASK, origin, real(0.0), direction,
                          nearest.distance);
    while (rayQueryProceedEXT(query)) {
        int index = int(element_order[rayQueryGetIntersectionPrimitiveIndexEXT(query, false)]);
        ElementMeeting meeting = meet_element(elements[index], origin, direction, index == left, least);
        if (meeting.found && meeting.distance < nearest.distance) {
            nearest.index = index;
            nearest.distance = meeting.distance;
            rayQueryGenerateIntersectionEXT(query, meeting.distance);
        }
    }
    return nearest;
}
#else
ElementHit nearest_element(real3 origin, real3 direction, int left) {
    real least = least_distance(origin);
    ElementHit nearest;
    nearest.index = -1;
    nearest.distance = FARTHEST;
    // Boxes and origin are as far apart as the instrument is long.
    real reach = max(max(abs(origin.x), abs(origin.y)), max(abs(origin.z), real(1e3)));
    BvhWalk walk = bvh_walk(batch.elements_root, origin, direction, real(0.0), real(16.0) * SURFACE_EPSILON * reach);
    while (bvh_proceed(walk, nearest.distance)) {
        int index = int(element_order[walk.primitive]);
        ElementMeeting meeting = meet_element(elements[index], origin, direction, index == left, least);
        if (meeting.found && meeting.distance < nearest.distance) {
            nearest.index = index;
            nearest.distance = meeting.distance;
        }
    }
    return nearest;
}
#endif
