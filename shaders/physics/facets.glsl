// Elements whose form is a mesh of flat facets. Light is inside a closed mesh or outside; it enters and leaves through
// facets that show it the proper side, so a facet beside the one that it comes from is not taken for another surface.

struct FacetMeeting {
    bool found;
    bool leaving;  // from inside to outside
    real distance; // mm, may be negative
    real v;        // barycentrics of corners b and c
    real w;
};

VKFV_FUNCTION FacetMeeting meet_facet(RayFrame frame, Facet facet) {
    real3 a = in_frame(frame, facet.corner_a);
    real3 b = in_frame(frame, facet.corner_b);
    real3 c = in_frame(frame, facet.corner_c);
    VKFV_PRECISE real u = c.x * b.y - c.y * b.x;
    VKFV_PRECISE real v = a.x * c.y - a.y * c.x;
    VKFV_PRECISE real w = b.x * a.y - b.y * a.x;
    real total = u + v + w;
    FacetMeeting meeting;
    meeting.found =
        (min(u, min(v, w)) >= real(0.0) || max(u, max(v, w)) <= real(0.0)) && total != real(0.0); // false: edge-on
    meeting.leaving = total < real(0.0); // decided by the corners, as a normal may round to the other side
    real inverse = meeting.found ? real(1.0) / total : real(0.0);
    meeting.distance = (u * a.z + v * b.z + w * c.z) * inverse;
    meeting.v = v * inverse;
    meeting.w = w * inverse;
    return meeting;
}

// ElementHit::index for light that is where it cannot be: rounding has put its start beside an edge, or bodies overlap.
const int ASTRAY = -2;

// The nearest meeting that a traversal of the elements has found so far.
struct NearestElement {
    ElementHit hit;
    real wrong_side; // mm, distance to the nearest facet ahead that shows the side on which the light is not
};

// The start of a traversal. farthest: mm; nothing beyond is met.
VKFV_FUNCTION NearestElement no_element(real farthest) {
    NearestElement nearest;
    nearest.hit.index = -1;
    nearest.hit.facet = -1;
    nearest.hit.distance = farthest;
    nearest.wrong_side = farthest;
    return nearest;
}

// Keeps a facet if it is the nearest so far. rounding: mm, of the ray's start.
VKFV_FUNCTION NearestElement consider_facet(NearestElement nearest, RayFrame frame, Facet facet, int index,
                                            PathPlace from, real rounding) {
    FacetMeeting meeting = meet_facet(frame, facet);
    bool met = meeting.found && index != from.facet && meeting.distance > real(0.0);
    bool proper = facet.closed == 0u || meeting.leaving == (from.inside == facet.element);
    // On a common edge the lower index wins, so that the result does not depend on the order of traversal.
    bool nearer = meeting.distance < nearest.hit.distance ||
                  (meeting.distance == nearest.hit.distance && index < nearest.hit.facet);
    if (met && proper && nearer) {
        nearest.hit.index = facet.element;
        nearest.hit.facet = index;
        nearest.hit.distance = meeting.distance;
    } else if (met && !proper && meeting.distance > rounding) {
        nearest.wrong_side = min(nearest.wrong_side, meeting.distance);
    }
    return nearest;
}

VKFV_FUNCTION ElementHit nearest_hit(NearestElement nearest, PathPlace from) {
    ElementHit hit = nearest.hit;
    // A mesh can be left only through its facets.
    bool astray = nearest.wrong_side < hit.distance || (from.inside >= 0 && hit.facet < 0);
    hit.index = astray ? ASTRAY : hit.index;
    return hit;
}
