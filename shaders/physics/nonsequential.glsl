// Non-sequential paths: at every interaction a ray meets the nearest of all elements and the specimen, and one of the
// two rays that an interface makes of one is drawn with its share of the power (Russian roulette, so every ray keeps
// its power). The frame is the elements', which is the specimen's with its origin in the plane of best focus; mm,
// directions are unit vectors.

#ifdef __cplusplus
template <class Scene>
Element element_at(const Scene& scene, int index) {
    return scene.element_at(index);
}
template <class Scene>
Facet facet_at(const Scene& scene, int index) {
    return scene.facet_at(index);
}
// The nearest element that the ray meets.
template <class Scene>
ElementHit nearest_element(const Scene& scene, real3 origin, real3 direction, PathPlace from) {
    return scene.nearest_element(origin, direction, from);
}
#else
Element element_at(int index);
Facet facet_at(int index);
ElementHit nearest_element(real3 origin, real3 direction, PathPlace from);
#endif

VKFV_FUNCTION real3 into_element(Element element, real3 v) {
    return real3(dot(element.axis_x, v), dot(element.axis_y, v), dot(element.axis_z, v));
}

VKFV_FUNCTION real3 out_of_element(Element element, real3 v) {
    return element.axis_x * v.x + element.axis_y * v.y + element.axis_z * v.z;
}

// The meeting of a ray with one element, in the element's frame turned so that the ray travels towards +z.
struct ElementMeeting {
    bool found;
    bool clear;    // within the free aperture
    real distance; // mm
    real3 point;
    real3 direction; // the ray's direction
    real3 normal;    // normal, not of unit length, towards +z
    real side;       // 1: the ray travels along the element's own z, -1: against it
};

VKFV_FUNCTION Surface seen_from(Surface surface, real side) {
    Surface seen = surface;
    seen.curvature = side * surface.curvature;
    seen.a4 = side * surface.a4;
    seen.a6 = side * surface.a6;
    seen.a8 = side * surface.a8;
    seen.a10 = side * surface.a10;
    seen.a12 = side * surface.a12;
    seen.a14 = side * surface.a14;
    seen.a16 = side * surface.a16;
    return seen;
}

// The meeting with the wall of a tube about z from z = 0 to `length`, from inside or outside.
VKFV_FUNCTION ElementMeeting meet_barrel(ElementMeeting meeting, Element element, real3 start, real least) {
    real3 d = meeting.direction;
    real a = d.x * d.x + d.y * d.y;
    real b = start.x * d.x + start.y * d.y;
    real c = start.x * start.x + start.y * start.y - element.outer_radius * element.outer_radius;
    real discriminant = b * b - a * c;
    real root = sqrt(max(discriminant, real(0.0)));
    real far = (root - b) / max(a, real(1e-20));
    real near = (-root - b) / max(a, real(1e-20));
    // The wall lies between the heights low and high of the turned frame.
    real low = meeting.side > real(0.0) ? real(0.0) : -element.barrel_length;
    real high = low + element.barrel_length;
    real near_z = start.z + near * d.z;
    real far_z = start.z + far * d.z;
    bool near_met = near > least && near_z >= low && near_z <= high;
    bool far_met = far > least && far_z >= low && far_z <= high;
    meeting.found = discriminant > real(0.0) && a > real(1e-20) && (near_met || far_met);
    meeting.distance = near_met ? near : far;
    meeting.clear = false;
    return meeting;
}

// The meeting of a ray with one element. least: mm; nearer meetings are the start itself. comes_from_it: the ray starts
// on this element, so that one of a conic's two meetings is the start.
VKFV_FUNCTION ElementMeeting meet_element(Element element, real3 origin, real3 direction, bool comes_from_it,
                                          real least) {
    real3 local = into_element(element, origin - element.origin);
    real3 d = into_element(element, direction);
    ElementMeeting meeting;
    meeting.side = d.z < real(0.0) ? real(-1.0) : real(1.0);
    real3 start = real3(local.x, local.y, meeting.side * local.z);
    meeting.direction = real3(d.x, d.y, meeting.side * d.z);
    meeting.normal = real3(real(0.0), real(0.0), real(1.0));
    meeting.found = false;
    meeting.clear = false;
    meeting.distance = real(0.0);
    if (element.kind == ELEMENT_BARREL) {
        meeting = meet_barrel(meeting, element, start, least);
    } else {
        Surface surface = seen_from(element.surface, meeting.side);
        SurfacePoint on = meet_surface(start, meeting.direction, real(1.0), surface);
        meeting.distance = on.parameter;
        meeting.normal = normal_at(on);
        meeting.found = on.found && on.parameter > least && !comes_from_it;
        if (comes_from_it && surface.curvature != real(0.0) && (surface.flags & SURFACE_ASPHERIC) == 0u) {
            // On the conic the quadratic's constant term is zero: one root is the start, the other the meeting.
            real c = surface.curvature;
            real q = real(1.0) + surface.conic;
            real3 e = meeting.direction;
            real a = c * (e.x * e.x + e.y * e.y + q * e.z * e.z);
            real b = c * (start.x * e.x + start.y * e.y + q * start.z * e.z) - e.z;
            real other = real(-2.0) * b / a;
            meeting.distance = other;
            meeting.found = other > least;
            meeting.normal = conic_normal(start + other * e, c, surface.conic);
        }
        real3 point = start + meeting.distance * meeting.direction;
        real r_squared = point.x * point.x + point.y * point.y;
        meeting.clear = r_squared <= surface.semi_diameter_squared;
        // Meetings with the conic's far half do not count: rays across the axis would meet it too.
        bool near_half = (surface.flags & SURFACE_ASPHERIC) != 0u ||
                         surface.curvature * (real(1.0) + surface.conic) * point.z < real(1.0);
        // The mount is the same surface beyond the free aperture, and where that ends, the plane of its rim.
        bool on_surface = meeting.found && near_half && r_squared <= element.rim_radius * element.rim_radius;
        real to_rim = (meeting.side * element.rim_height - start.z) / max(meeting.direction.z, real(1e-20));
        real3 rim_point = start + to_rim * meeting.direction;
        real rim_squared = rim_point.x * rim_point.x + rim_point.y * rim_point.y;
        bool on_rim = to_rim > least && rim_squared > element.rim_radius * element.rim_radius &&
                      rim_squared <= element.outer_radius * element.outer_radius &&
                      (!on_surface || to_rim < meeting.distance);
        meeting.found = on_surface || on_rim;
        meeting.clear = meeting.clear && !on_rim;
        meeting.distance = on_rim ? to_rim : meeting.distance;
    }
    meeting.point = start + meeting.distance * meeting.direction;
    return meeting;
}

// The least distance at which a ray from `origin` may meet something: a few roundings of its coordinates.
VKFV_FUNCTION real least_distance(real3 origin) {
    real largest = max(max(abs(origin.x), abs(origin.y)), abs(origin.z));
    return real(16.0) * SURFACE_EPSILON * max(largest, real(1.0));
}

// The outcome of a ray's meeting with an element.
struct Passage {
    Fate fate; // PATH_ALIVE: the ray goes on
    real3 position;
    real3 direction; // unit
};

// The outcome in the frame of the meeting. before, after: indices of the media; normal: unit. clear: the ray is within
// the free aperture, not on the mount. u: uniform in (0, 1), chooses among the possible rays.
VKFV_FUNCTION Passage turn_at(Element element, int index, bool clear, real3 point, real3 direction, real3 normal,
                              real before, real after, Light light, real u) {
    Surface surface = element.surface;
    real cosine = min(dot(direction, normal), real(1.0));
    uint status = PATH_ALIVE;
    if (!clear || element.kind == ELEMENT_DETECTOR || element.kind == ELEMENT_ABSORBER) {
        status = PATH_VIGNETTED; // by the mount or the detector's back
    } else if (element.kind == ELEMENT_INTERFACE) {
        real reflectance = interface_reflectance(surface, before, after, cosine, light.wave_number);
        if (refracted_sine_squared(before, after, cosine) >= real(1.0) || u < reflectance) {
            direction = mirrored(direction, normal);
        } else {
            direction = refract_unit(direction, normal, before, after, cosine);
        }
    } else if (element.kind == ELEMENT_MIRROR) {
        direction = mirrored(direction, normal);
        status = u < surface.reflectance ? PATH_ALIVE : PATH_INTERFACE_LOSS;
    } else if (element.kind == ELEMENT_SPLITTER) {
        if (u < surface.reflectance) {
            direction = mirrored(direction, normal);
        } else {
            status = u < surface.reflectance + element.transmittance ? PATH_ALIVE : PATH_INTERFACE_LOSS;
            direction = refract_unit(direction, normal, before, after, cosine); // a plate's coated face refracts
        }
    } else if (element.kind == ELEMENT_IDEAL_LENS) {
        IdealLens lens = pass_ideal_lens(point, direction * before, surface.power, before, after);
        status = lens.passes ? PATH_ALIVE : PATH_TOTAL_REFLECTION;
        direction = lens.direction * (real(1.0) / after);
        // The ray starts in the lens' own plane, since something may stand between the lens and its focal plane.
        point = lens.position - lens.direction * (lens.position.z / lens.direction.z);
    }
    Passage passage;
    passage.fate = make_fate(status, status == PATH_ALIVE ? -1 : index);
    passage.position = point;
    passage.direction = direction;
    return passage;
}

VKFV_FUNCTION Passage pass_element(Element element, int index, ElementMeeting meeting, Light light, real u) {
    Surface surface = element.surface;
    bool along = meeting.side > real(0.0);
    real before = along ? surface.index_before + disperse(surface.dispersion_before, light.spectral)
                        : surface.index_after + disperse(surface.dispersion_after, light.spectral);
    real after = along ? surface.index_after + disperse(surface.dispersion_after, light.spectral)
                       : surface.index_before + disperse(surface.dispersion_before, light.spectral);
    real3 normal = meeting.normal * (real(1.0) / sqrt(dot(meeting.normal, meeting.normal)));
    Passage own =
        turn_at(element, index, meeting.clear, meeting.point, meeting.direction, normal, before, after, light, u);
    real3 own_point = real3(own.position.x, own.position.y, meeting.side * own.position.z);
    real3 own_direction = real3(own.direction.x, own.direction.y, meeting.side * own.direction.z);
    Passage passage;
    passage.fate = own.fate;
    passage.position = element.origin + out_of_element(element, own_point);
    real3 turned = out_of_element(element, own_direction);
    passage.direction = turned * (real(1.0) / sqrt(dot(turned, turned)));
    return passage;
}

struct FacetPassage {
    Passage passage;
    int inside; // element of the closed mesh that the light is in afterwards, as PathPlace::inside
};

// The outcome of a ray's meeting with a facet. The surface's index_before is that of the medium outside the mesh,
// index_after that inside.
VKFV_FUNCTION FacetPassage pass_facet(Element element, Facet facet, real3 origin, real3 direction, int inside,
                                      Light light, real u) {
    FacetMeeting meeting = meet_facet(ray_frame(origin, direction), facet);
    Surface surface = element.surface;
    real outer = surface.index_before + disperse(surface.dispersion_before, light.spectral);
    real inner = surface.index_after + disperse(surface.dispersion_after, light.spectral);
    // The point is computed from the corners, so that it lies on the facet however far the ray came.
    real3 point =
        facet.corner_a + meeting.v * (facet.corner_b - facet.corner_a) + meeting.w * (facet.corner_c - facet.corner_a);
    real3 normal = facet.normal * (meeting.leaving ? real(1.0) : real(-1.0));
    FacetPassage result;
    result.passage = turn_at(element, facet.element, true, point, direction, normal, meeting.leaving ? inner : outer,
                             meeting.leaving ? outer : inner, light, u);
    real3 turned = result.passage.direction;
    result.passage.direction = turned * (real(1.0) / sqrt(dot(turned, turned)));
    bool refracted = element.kind == ELEMENT_INTERFACE && dot(turned, normal) > real(0.0);
    result.inside = refracted ? (meeting.leaving ? -1 : facet.element) : inside;
    return result;
}

// Most interactions, with elements or the specimen, that a path may have: about twice those of the sequential model's
// longest. The ledger counts paths that reach the limit.
const int MOST_INTERACTIONS = 128;
// Blocks of random numbers: one an interaction from 1 on; those of the scatter events begin here.
const uint SCATTER_FIRST_BLOCK = 256u;

// Traces one non-sequential path from the source to its end.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Detection trace_nonsequential(VKFV_SCENE_PARAMETER Instrument instrument,
                                                                SpecimenRecord specimen, Exposure exposure,
                                                                SourceFrame frame, uvec2 path) {
    Draws draws = draw(exposure.seed, exposure.image, path, 0u);
    Emission emission = emit(VKFV_SCENE instrument, draws);
    real3 p = emission.ray.position;
    real3 d = emission.ray.direction;
    real3 origin = frame.origin + frame.axis_x * p.x + frame.axis_y * p.y + frame.axis_z * p.z;
    real3 direction = frame.axis_x * d.x + frame.axis_y * d.y + frame.axis_z * d.z;
    Detection detection;
    detection.fate = make_fate(PATH_ALIVE, -1);
    detection.column = 0;
    detection.row = 0;
    detection.x = real(0.0);
    detection.y = real(0.0);
    detection.recorded = real2(real(0.0), real(0.0));
    real3 to_specimen = real3(real(0.0), real(0.0), exposure.focal_height) - displacement(exposure);
    PathPlace place;
    place.element = -1;
    place.facet = -1;
    place.inside = -1;
    int bounces = 0;
    for (int k = 0; k < MOST_INTERACTIONS && detection.fate.status == PATH_ALIVE; ++k) {
        ElementHit met = nearest_element(VKFV_SCENE origin, direction, place);
        Hit hit = specimen_hit(VKFV_SCENE origin + to_specimen, direction);
        bool on_specimen = hit.found == 1u && (met.index < 0 || hit.distance < met.distance);
        if ((features(VKFV_SCENE_ALONE) & FEATURE_FACETS) != 0u &&
            (met.index == ASTRAY || (on_specimen && place.inside >= 0))) {
            detection.fate = make_fate(PATH_NUMERICAL, -1);
        } else if (on_specimen) {
            if (bounces == specimen.max_bounces) {
                detection.fate = make_fate(PATH_BOUNCE_LIMIT, -1);
            } else {
                Material material = material_of_light(VKFV_SCENE instrument, specimen,
                                                      material_at(VKFV_SCENE specimen, hit.position), emission.light);
                Scattered scattered = scatter(VKFV_SCENE material, direction, hit.normal, exposure.seed, exposure.image,
                                              path, SCATTER_FIRST_BLOCK + uint(bounces) * SCATTER_BLOCKS);
                direction = scattered.direction;
                origin = scatter_origin(hit) - to_specimen;
                detection.fate = make_fate(scattered.absorbed   ? PATH_ABSORBED
                                           : scattered.accepted ? PATH_ALIVE
                                                                : PATH_NUMERICAL,
                                           -1);
                bounces += 1;
                place.element = -1;
                place.facet = -1;
            }
        } else if (met.index < 0) {
            detection.fate = make_fate(PATH_ESCAPED, -1);
        } else if ((features(VKFV_SCENE_ALONE) & FEATURE_FACETS) != 0u && met.facet >= 0) {
            Draws turn = draw(exposure.seed, exposure.image, path, 1u + uint(k));
            FacetPassage through = pass_facet(element_at(VKFV_SCENE met.index), facet_at(VKFV_SCENE met.facet), origin,
                                              direction, place.inside, emission.light, turn.u0);
            detection.fate = through.passage.fate;
            origin = through.passage.position;
            direction = through.passage.direction;
            place.element = -1;
            place.facet = met.facet;
            place.inside = through.inside;
        } else {
            Element element = element_at(VKFV_SCENE met.index);
            ElementMeeting meeting =
                meet_element(element, origin, direction, met.index == place.element, least_distance(origin));
            if (element.kind == ELEMENT_DETECTOR && meeting.clear && meeting.side > real(0.0)) {
                detection = detect(instrument, exposure, meeting.point.x, meeting.point.y);
            } else {
                Draws turn = draw(exposure.seed, exposure.image, path, 1u + uint(k));
                Passage passage = pass_element(element, met.index, meeting, emission.light, turn.u0);
                detection.fate = passage.fate;
                if (passage.fate.status == PATH_ALIVE &&
                    turn.u1 >= light_field_at(VKFV_SCENE element.surface, meeting.point.x, meeting.point.y)) {
                    detection.fate = make_fate(PATH_INTERFACE_LOSS, met.index);
                }
                origin = passage.position;
                direction = passage.direction;
                place.element = met.index;
                place.facet = -1;
            }
        }
    }
    if (detection.fate.status == PATH_ALIVE) {
        detection.fate = make_fate(PATH_INTERACTION_LIMIT, -1);
    }
    return detection;
}
