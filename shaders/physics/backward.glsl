// Backward paths: from a point of a pixel through the imaging train to the specimen, and from there to the source,
// whose radiance they collect. Radiance is constant along a ray (times the transmittances; over the square of the
// index, which is 1 at both ends), so a pixel's flux is
//   Phi = L_source * integral over the pixel's area and the directions of  T cos(theta) dA domega,
// where T is the share of the source's radiance that the specimen sends on: the integral of bsdf(in -> out)
// cos(theta_in) over the directions in which the source is seen. A path's value is an unbiased estimate of T
// cos^4(theta) for directions that are uniform over the exit pupil's disc, so that Phi is the mean value times L_source
// A_pixel (disc's area in slopes).
//
// The Instrument is reversed (optics::turned_round()): its illumination train leads from the detector to the specimen,
// its imaging train from the specimen to the source, where the last surface is the source itself as a stop. Linear
// bounds say which rays can carry light. For a ray through the plane of the detector,
//   |pupil_position * (x, y) + (dx/dz, dy/dz)| <= pupil_radius
// in the reversed frame holds for all light from the specimen, and for a ray through the plane of the paraxial object
//   |source_position * (x, y) + (dx/dz, dy/dz)| <= source_outer
// for all light from the source. A ray within source_inner, from a point within inner_field, is from the source for
// sure. Points of a ring light are drawn directly, as seen without a cover glass; over a glass the drawn ring is a
// little larger, and only tracing shows which rays meet the real one.
// clang-format off
#define VKFV_BACKWARD_OPTICS_FIELDS(FIELD) \
    FIELD(real, pupil_position) \
    FIELD(real, pupil_radius) \
    FIELD(real, source_position) \
    FIELD(real, source_outer) \
    FIELD(real, source_inner)    /* 0: no point sees the source for sure */ \
    FIELD(real, inner_field)     /* mm */ \
    /* mm, from the objective's front vertex or cover glass to the paraxial object; of a ring light: to its aim */ \
    FIELD(real, object_distance) \
    FIELD(RingLight, ring)       /* ring light that directions are drawn on */ \
    FIELD(real, ring_area)       /* mm^2, of the drawn ring */ \
    FIELD(real, ring_cosine)     /* least cosine between light and the band's normal */ \
    FIELD(uint, ring_is_bare)    /* 1: the drawn ring is the real one */ \
    FIELD(uint, cone_candidates) /* directions towards the source that each scatter event weighs against each other */ \
    FIELD(uint, lobe_candidates) /* directions of the lobe besides, 0 or 1 */ \
    FIELD(uint, sure_candidates) /* cone_candidates for the part seen for sure, where the rim is sampled by itself */ \
    FIELD(uint, rim_period)      /* a power of 2: one in so many paths samples the source's rim; 0: not apart */
struct BackwardOptics {
    VKFV_BACKWARD_OPTICS_FIELDS(VKFV_DECLARE)
};
// clang-format on

// The lattice's dimensions: pixel 0 and 1, pupil 2 and 3, direction to the source 4 and 5 (for its rim two others),
// choice among candidates 6, wavelength 7. Draws after the first scatter event are from Philox.

// Light that is traced backward from the detector, at the specimen's top plane.
struct BackwardArrival {
    uint status;
    real weight;     // cos^4 at the detector times the transmittance
    real3 position;  // on the plane z = top, specimen frame
    real3 direction; // unit, downward
    Light light;
};

// Traces from the detector to the specimen's top plane. x, y: position on the detector's plane as in Detection, mm.
// pupil: a point of the unit disc.
VKFV_SCENE_FUNCTION VKFV_FUNCTION BackwardArrival look_from_detector(VKFV_SCENE_PARAMETER Instrument instrument,
                                                                     BackwardOptics backward, SpecimenRecord specimen,
                                                                     Exposure exposure, real x, real y, real2 pupil,
                                                                     Light light) {
    // The reversed frame is the detector's turned by half a turn about x.
    real2 slope = real2(backward.pupil_radius * pupil.x - backward.pupil_position * x,
                        backward.pupil_radius * pupil.y + backward.pupil_position * y);
    real axial_squared = real(1.0) / (real(1.0) + slope.x * slope.x + slope.y * slope.y);
    real axial = sqrt(axial_squared);
    Ray ray;
    ray.position = real3(x, -y, real(0.0));
    ray.direction = real3(slope.x * axial, slope.y * axial, axial);
    ray.path_length = real(0.0);
    real specimen_index = specimen_medium_index(instrument, light);
    TrainResult train = trace_short_train(VKFV_SCENE instrument.illumination_first, instrument.illumination_count, ray,
                                          real(1.0), light, SHORT_TRAIN_FINE);
    Ray down = fly_to_top(train.ray, exposure, specimen_index);
    real scale = real(1.0) / specimen_index;
    BackwardArrival arrival;
    arrival.status = train.status;
    arrival.weight = axial_squared * axial_squared * train.transmitted;
    arrival.position = real3(down.position.x, -down.position.y, specimen.top);
    arrival.direction = real3(down.direction.x * scale, -down.direction.y * scale, -down.direction.z * scale);
    arrival.light = light;
    return arrival;
}

// Height of the paraxial object plane, or of a ring light's aim, in the specimen frame, mm.
VKFV_FUNCTION real object_plane(BackwardOptics backward, SpecimenRecord specimen, Exposure exposure) {
    return specimen.top + exposure.top_distance - backward.object_distance;
}

// A ray from the specimen towards the source, and the light that it brings if it comes from there.
struct SourceQuery {
    real3 position;  // specimen frame
    real3 direction; // unit, towards the source
    real weight;     // factor of the source's radiance
    Light light;
};

const uint SOURCE_HIDDEN = 0u;
const uint SOURCE_SEEN = 1u;
const uint SOURCE_UNKNOWN = 2u; // only tracing shows it

// The point of the drawn ring light that a ray meets.
VKFV_FUNCTION RingMeeting meet_drawn_ring(BackwardOptics backward, real plane, real3 position, real3 direction) {
    RingMeeting meeting = meet_ring(backward.ring, real3(position.x, position.y, position.z - plane), direction);
    meeting.found = meeting.found && meeting.cosine >= backward.ring_cosine;
    return meeting;
}

VKFV_SCENE_FUNCTION VKFV_FUNCTION uint source_certainty(VKFV_SCENE_PARAMETER BackwardOptics backward, real plane,
                                                        SourceQuery query) {
    if ((features(VKFV_SCENE_ALONE) & FEATURE_RING) != 0u) {
        bool possible = meet_drawn_ring(backward, plane, query.position, query.direction).found;
        return !possible ? SOURCE_HIDDEN : backward.ring_is_bare != 0u ? SOURCE_SEEN : SOURCE_UNKNOWN;
    }
    real2 slope = real2(query.direction.x, query.direction.y) / query.direction.z;
    real2 field = real2(query.position.x, query.position.y) + slope * (plane - query.position.z);
    real2 crossing = field * backward.source_position + slope;
    real crossing_squared = dot(crossing, crossing);
    bool possible = query.direction.z > real(0.0) && crossing_squared <= backward.source_outer * backward.source_outer;
    bool sure = crossing_squared <= backward.source_inner * backward.source_inner &&
                dot(field, field) <= backward.inner_field * backward.inner_field;
    return !possible ? SOURCE_HIDDEN : sure ? SOURCE_SEEN : SOURCE_UNKNOWN;
}

// The weight times the transmittance from the source to the specimen, 0 if the ray does not meet the source.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real trace_to_source(VKFV_SCENE_PARAMETER Instrument instrument,
                                                       SpecimenRecord specimen, Exposure exposure, SourceQuery query) {
    real rise = rise_to_top(specimen, exposure, query.position.z) / query.direction.z;
    real index = specimen_medium_index(instrument, query.light);
    Ray ray;
    ray.position = real3(query.position.x + query.direction.x * rise, query.position.y + query.direction.y * rise,
                         -exposure.top_distance);
    ray.direction = query.direction * index;
    ray.path_length = real(0.0);
    TrainResult train = trace_short_train_by_loop(VKFV_SCENE instrument.imaging_first, instrument.imaging_count, ray,
                                                  index, query.light, SHORT_TRAIN_PLAIN);
    bool arrives = train.status == PATH_ALIVE;
    if (arrives && (features(VKFV_SCENE_ALONE) & FEATURE_RING) != 0u) {
        real3 from_aim =
            real3(train.ray.position.x, train.ray.position.y, train.ray.position.z + instrument.ring.aim_distance);
        RingMeeting meeting = meet_ring(instrument.ring, from_aim, train.ray.direction / index);
        real emission_cosine = sqrt(max(real(1.0) - instrument.emission_sine * instrument.emission_sine, real(0.0)));
        arrives = meeting.found && meeting.cosine >= emission_cosine;
    } else if (arrives && (features(VKFV_SCENE_ALONE) & FEATURE_RECTANGLE) != 0u) {
        // The last surface is the circle about the rectangle. Its frame is the source's turned by half a turn about x.
        arrives = abs(train.ray.position.x) <= instrument.source_half_width &&
                  abs(train.ray.position.y) <= instrument.source_half_height;
    }
    return arrives ? query.weight * train.transmitted : real(0.0);
}

// Answers a query that only tracing can decide, at once or later with others; returns the value to add now.
#ifdef __cplusplus
template <class Scene>
real ask_source(const Scene& scene, Instrument instrument, SpecimenRecord specimen, Exposure exposure,
                SourceQuery query) {
    return trace_to_source(scene, instrument, specimen, exposure, query);
}
#else
real ask_source(Instrument instrument, SpecimenRecord specimen, Exposure exposure, SourceQuery query);
#endif

VKFV_SCENE_FUNCTION VKFV_FUNCTION real collect(VKFV_SCENE_PARAMETER Instrument instrument, BackwardOptics backward,
                                               real plane, SpecimenRecord specimen, Exposure exposure,
                                               SourceQuery query) {
    uint certainty = source_certainty(VKFV_SCENE backward, plane, query);
    real value = certainty == SOURCE_SEEN ? query.weight : real(0.0);
    if (certainty == SOURCE_UNKNOWN) {
        value = ask_source(VKFV_SCENE instrument, specimen, exposure, query);
    }
    return value;
}

// A candidate for a connection: a direction towards the source, and the density of such directions per solid angle.
struct Candidate {
    bool usable;
    real3 direction;
    real density; // per sr, of one of the candidates drawn on the source
};

// Part of the paraxial source as seen from a point: a disc of slopes, or a ring of them around an inner disc.
struct SeenPart {
    real2 centre;
    real inner;
    real outer;
};
VKFV_FUNCTION SeenPart seen_whole(BackwardOptics backward, real plane, real3 position) {
    real factor = real(1.0) / (real(1.0) + backward.source_position * (plane - position.z));
    SeenPart whole;
    whole.centre = real2(position.x, position.y) * (-backward.source_position * factor);
    whole.inner = real(0.0);
    whole.outer = backward.source_outer * factor;
    return whole;
}

// Radius of the part of the source that the point sees for sure, if all its directions cross the object plane within
// the inner field; else 0.
VKFV_FUNCTION real sure_radius(BackwardOptics backward, real plane, real3 position, SeenPart whole) {
    real rise = plane - position.z;
    real radius = whole.outer * (backward.source_inner / backward.source_outer);
    real2 middle = real2(position.x, position.y) + whole.centre * rise;
    real within = backward.inner_field - radius * abs(rise);
    return within > real(0.0) && dot(middle, middle) <= within * within ? radius : real(0.0);
}

VKFV_FUNCTION Candidate in_part(SeenPart part, real3 direction) {
    real2 from_centre = real2(direction.x, direction.y) / direction.z - part.centre;
    real apart_squared = dot(from_centre, from_centre);
    real inner_squared = part.inner * part.inner;
    real outer_squared = part.outer * part.outer;
    Candidate candidate;
    candidate.direction = direction;
    candidate.usable = direction.z > real(0.0) && apart_squared <= outer_squared && apart_squared >= inner_squared;
    // The solid angle is cos^3 times the area in slopes.
    candidate.density = real(1.0) / (real(3.14159265358979324) * (outer_squared - inner_squared) * direction.z *
                                     direction.z * direction.z);
    return candidate;
}

VKFV_FUNCTION Candidate draw_in_part(SeenPart part, real u0, real u1) {
    real inner_squared = part.inner * part.inner;
    real rho = sqrt(inner_squared + u0 * (part.outer * part.outer - inner_squared));
    Turn turn = turn_of(u1);
    real2 slope = part.centre + real2(turn.cosine, turn.sine) * rho;
    Candidate candidate =
        in_part(part, real3(slope.x, slope.y, real(1.0)) * (real(1.0) / sqrt(real(1.0) + dot(slope, slope))));
    candidate.usable = true; // usable even on the edge of the part, where rounding decides
    return candidate;
}

VKFV_FUNCTION Candidate on_ring(BackwardOptics backward, real3 direction, RingMeeting meeting) {
    Candidate candidate;
    candidate.direction = direction;
    candidate.usable = meeting.found;
    candidate.density = meeting.distance * meeting.distance / (meeting.cosine * backward.ring_area);
    return candidate;
}

VKFV_FUNCTION Candidate draw_on_ring(BackwardOptics backward, real plane, real3 position, real u0, real u1) {
    RingPoint point = ring_point(backward.ring, u0, u1);
    real3 way =
        real3(point.position.x - position.x, -point.position.y - position.y, plane - point.position.z - position.z);
    RingMeeting meeting;
    meeting.distance = sqrt(dot(way, way));
    real3 direction = way / meeting.distance;
    meeting.cosine = -dot(direction, real3(point.normal.x, -point.normal.y, -point.normal.z));
    meeting.found = meeting.cosine > real(0.0) && meeting.cosine >= backward.ring_cosine;
    return on_ring(backward, direction, meeting);
}

// A direction towards the source, chosen in proportion to the light that it would scatter towards the detector, and the
// estimate of all of that light per radiance of the source.
struct Connection {
    real weight;
    real3 direction;
};

// Resampled importance sampling (J. Talbot, D. Cline, P. Egbert, EGSR 2005) from stratified candidates: some uniform
// over the source's disc or ring, one drawn from the lobe seen backward. Each has the weight f / (sum of all
// candidates' densities), by the balance heuristic.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Connection connect(VKFV_SCENE_PARAMETER Material material, BackwardOptics backward,
                                                     real plane, SeenPart part, uint cone_candidates, Hit hit,
                                                     real3 outgoing, real u0, real u1, real choice, Scattered of_lobe) {
    bool is_ring = (features(VKFV_SCENE_ALONE) & FEATURE_RING) != 0u;
    Connection connection;
    connection.weight = real(0.0);
    connection.direction = real3(real(0.0), real(0.0), real(1.0));
    real u = choice;
    for (uint k = 0u; k < cone_candidates + backward.lobe_candidates; ++k) {
        Candidate candidate;
        if (k < cone_candidates) {
            // The candidates divide the part into equal areas, each turned by the golden angle against the one before.
            real first = (real(k) + u0) / real(cone_candidates);
            real second = fract(u1 + real(k) * real(0.61803398874989485));
            if (is_ring) {
                candidate = draw_on_ring(backward, plane, hit.position, first, second);
            } else {
                candidate = draw_in_part(part, first, second);
            }
        } else {
            if (is_ring) {
                candidate = on_ring(backward, of_lobe.direction,
                                    meet_drawn_ring(backward, plane, hit.position, of_lobe.direction));
            } else {
                candidate = in_part(part, of_lobe.direction);
            }
            candidate.usable = candidate.usable && of_lobe.accepted;
        }
        real3 direction = candidate.direction;
        real cosine = dot(direction, hit.normal);
        if (candidate.usable && cosine > real(0.0)) {
            real flux = scatter_bsdf(VKFV_SCENE material, -direction, hit.normal, outgoing) * cosine;
            real density = real(cone_candidates) * candidate.density;
            if (backward.lobe_candidates != 0u) {
                density = density + real(backward.lobe_candidates) *
                                        scatter_density(VKFV_SCENE material, -outgoing, hit.normal, direction);
            }
            real weight = flux / density;
            connection.weight = connection.weight + weight;
            if (weight > real(0.0)) {
                // The rest of the number that chose is uniform again, so it serves as a new one.
                real share = weight / connection.weight;
                bool chosen = u < share;
                u = chosen ? u / share : (u - share) / (real(1.0) - share);
                connection.direction = chosen ? direction : connection.direction;
            }
        }
    }
    return connection;
}

// A material of one lobe of weight 1 in all wavelengths.
VKFV_FUNCTION Material material_of_lobe(Lobe lobe) {
    Material material;
    material.lobe_0 = lobe;
    material.lobe_0.weight = real(1.0);
    material.lobe_1 = lobe;
    material.lobe_1.weight = real(0.0);
    material.lobe_2 = material.lobe_1;
    material.lobe_3 = material.lobe_1;
    return material;
}

// True if a lobe is a delta. A lobe that has a density has one in the mirror direction too. A lobe with numbers from a
// file is never a delta.
VKFV_SCENE_FUNCTION VKFV_FUNCTION bool lobe_is_delta(VKFV_SCENE_PARAMETER Lobe lobe) {
    bool delta = false;
    if ((scatter_models & SCATTER_DELTA) != 0u) {
        real3 up = real3(real(0.0), real(0.0), real(1.0));
        delta = !lobe_has_numbers(lobe) && scatter_density(VKFV_SCENE material_of_lobe(lobe), -up, up, up) == real(0.0);
    }
    return delta;
}

#ifdef __cplusplus
inline bool lobe_is_delta(Lobe lobe) { return lobe_is_delta(NoNumbers{}, lobe); }
#endif

// The point on a pixel and in the pupil from which a path starts.
struct BackwardStart {
    real column; // column within the pixel, in [0, 1)
    real row;
    real2 pupil; // a point of the unit disc, as for look_from_detector()
};

VKFV_FUNCTION BackwardStart backward_start(Lattice lattice, LatticeShift shift, uint point) {
    real rho = sqrt(lattice_coordinate(lattice, point, lattice.z_2, shift.first.z));
    Turn azimuth = turn_of(lattice_coordinate(lattice, point, lattice.z_3, shift.first.w));
    BackwardStart start;
    start.column = lattice_coordinate(lattice, point, lattice.z_0, shift.first.x);
    start.row = lattice_coordinate(lattice, point, lattice.z_1, shift.first.y);
    start.pupil = real2(rho * azimuth.cosine, rho * azimuth.sine);
    return start;
}

// The start moved onto the sensitive part of a pixel, which is a square about its middle.
VKFV_FUNCTION BackwardStart on_sensitive(Instrument instrument, BackwardStart start) {
    real side = min(real(2.0) * instrument.pixel_reach, real(1.0));
    start.column = real(0.5) + (start.column - real(0.5)) * side;
    start.row = real(0.5) + (start.row - real(0.5)) * side;
    return start;
}

// The pupil cell and pixel part that the light of a path is sorted to. In the detector's frame light arrives with the
// slope (-pupil_radius pupil.x, pupil_radius pupil.y) plus a slope of pupil_position times its place; a tilted
// detector's chief ray has an own slope besides.
VKFV_FUNCTION CellPlace backward_place(BackwardOptics backward, PupilCells cells, int column, int row,
                                       BackwardStart start) {
    CellPlace place;
    place.column = column * int(cells.parts) + pixel_part(cells, start.column);
    place.row = row * int(cells.parts) + pixel_part(cells, start.row);
    real2 slope = real2(-backward.pupil_radius * start.pupil.x, backward.pupil_radius * start.pupil.y);
    place.cell = pupil_cell(cells, slope - real2(cells.chief_x, cells.chief_y));
    return place;
}

// The value of one path (see above), for one point of a pixel's lattice; the point's number keys further draws. It
// queries the source at most once at each bounce and once at its end.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real trace_backward(VKFV_SCENE_PARAMETER Instrument instrument,
                                                      BackwardOptics backward, SpecimenRecord specimen,
                                                      Exposure exposure, int column, int row, uint randomisation,
                                                      Lattice lattice, LatticeShift shift, uint point) {
    real turn = instrument.magnification < real(0.0) ? real(-1.0) : real(1.0);
    real pitch = real(2.0) * instrument.detector_half_width / real(instrument.detector_columns);
    BackwardStart start = backward_start(lattice, shift, point);
    start = on_sensitive(instrument, start);
    ArrivalPlace watched =
        arrival_place(instrument, exposure,
                      turn * real2((real(column) + start.column) * pitch - instrument.detector_half_width,
                                   (real(row) + start.row) * pitch - instrument.detector_half_height));
    Light light = light_of_spectral(instrument, real(0.0));
    if ((features(VKFV_SCENE_ALONE) & FEATURE_SPECTRUM) != 0u) {
        light = draw_light(VKFV_SCENE instrument, lattice_coordinate(lattice, point, lattice.z_7, shift.second.w));
    }
    BackwardArrival arrival = look_from_detector(VKFV_SCENE instrument, backward, specimen, exposure, watched.place.x,
                                                 watched.place.y, start.pupil, light);
    real value = real(0.0);
    real throughput = arrival.weight * watched.area;
    if ((features(VKFV_SCENE_ALONE) & FEATURE_RING) != 0u) {
        // The ring stands in the specimen's medium, where radiance is the squared index times that in air.
        real index = specimen_medium_index(instrument, light);
        throughput = throughput / (index * index);
    }
    Material material = material_of_light(VKFV_SCENE instrument, specimen, specimen.material, light);
    real3 direction = arrival.direction;
    real plane = object_plane(backward, specimen, exposure);
    // No forward path has these counters; a lattice has fewer than 2^15 points.
    uvec2 path = uvec2(uint(row * instrument.detector_columns + column), 0x80000000u + (randomisation << 15) + point);
    SourceQuery query;
    query.light = light;
    bool under_way = arrival.status == PATH_ALIVE;
    Hit hit;
    hit.found = 0u;
    if (under_way) {
        hit = displaced_hit(VKFV_SCENE exposure, arrival.position, direction);
        under_way = hit.found == 1u && dot(direction, hit.normal) < real(0.0);
    }
    for (int bounce = 0; bounce < specimen.max_bounces && under_way; ++bounce) {
        uint block = 1u + uint(bounce) * (SCATTER_BLOCKS + 2u);
        real3 outgoing = -direction;
        real3 origin = scatter_origin(hit);
        throughput = throughput * reflectance_share(VKFV_SCENE specimen, hit.position - displacement(exposure));
        Draws draws;
        draws.u0 = lattice_coordinate(lattice, point, lattice.z_4, shift.second.x);
        draws.u1 = lattice_coordinate(lattice, point, lattice.z_5, shift.second.y);
        draws.u2 = lattice_coordinate(lattice, point, lattice.z_6, shift.second.z);
        draws.u3 = real(0.0);
        if (bounce > 0 || specimen.max_bounces > 1 || backward.lobe_candidates != 0u ||
            (scatter_models & SCATTER_DELTA) != 0u) {
            Draws further = draw(exposure.seed, exposure.image, path, block);
            draws.u3 = further.u3;
            draws.u0 = bounce == 0 ? draws.u0 : further.u0;
            draws.u1 = bounce == 0 ? draws.u1 : further.u1;
            draws.u2 = bounce == 0 ? draws.u2 : further.u2;
        }
        bool last = bounce + 1 == specimen.max_bounces;
        Lobe lobe = choose_lobe(material, draws.u3);
        bool delta = lobe_is_delta(VKFV_SCENE lobe);
        Material alone = material_of_lobe(lobe);
        // The lobe draws a direction as if the light came from the detector. It is a candidate for the connection, and
        // the path goes on by it.
        bool absorbed = lobe.model == SCATTER_NONE;
        under_way = !absorbed && (delta || !last);
        Scattered scattered;
        scattered.accepted = false;
        scattered.direction = outgoing;
        if (under_way || (backward.lobe_candidates != 0u && !absorbed)) {
            scattered =
                scatter(VKFV_SCENE alone, direction, hit.normal, exposure.seed, exposure.image, path, block + 1u);
        }
        under_way = under_way && scattered.accepted;
        scattered.accepted = scattered.accepted && !delta;
        // Directions in which the source is seen for sure give an estimate of low variance; its rim gives one of high
        // variance, but has less weight and is sampled less often. Elsewhere all of the source is sampled as one.
        SeenPart whole = seen_whole(backward, plane, hit.position);
        real sure = backward.rim_period != 0u ? sure_radius(backward, plane, hit.position, whole) : real(0.0);
        bool parted = sure > real(0.0);
        uint rim_period = max(backward.rim_period, 1u);
        bool looks_further = !parted || point % rim_period == 0u;
        real2 at_rim = real2(draws.u0, draws.u1);
        if (bounce == 0) {
            at_rim = sparse_coordinates(lattice, point, rim_period, shift.second.x, shift.second.y);
        }
        for (uint part = parted ? 0u : 1u; part < (looks_further ? 2u : 1u); ++part) {
            bool rim = parted && part == 1u;
            SeenPart seen = whole;
            seen.outer = part == 0u ? sure : whole.outer;
            seen.inner = rim ? sure : real(0.0);
            Connection connection =
                connect(VKFV_SCENE material, backward, plane, seen,
                        rim      ? 1u
                        : parted ? backward.sure_candidates
                                 : backward.cone_candidates,
                        hit, outgoing, rim ? at_rim.x : draws.u0, rim ? at_rim.y : draws.u1, draws.u2, scattered);
            if (connection.weight > real(0.0)) {
                Hit blocker = displaced_hit(VKFV_SCENE exposure, origin, connection.direction);
                if (blocker.found == 0u) {
                    query.position = origin;
                    query.direction = connection.direction;
                    query.weight = throughput * connection.weight * (rim ? real(rim_period) : real(1.0));
                    real seen_light = query.weight; // light of the part that is seen for sure
                    if (rim || !parted) {
                        seen_light = collect(VKFV_SCENE instrument, backward, plane, specimen, exposure, query);
                    }
                    value = value + seen_light;
                }
            }
            VKFV_LEAVE_IF(part == 1u || !looks_further);
        }
        if (under_way) {
            if (!delta) {
                real cosine = dot(scattered.direction, hit.normal);
                throughput = throughput * scatter_bsdf(VKFV_SCENE alone, -scattered.direction, hit.normal, outgoing) *
                             cosine / scatter_density(VKFV_SCENE alone, direction, hit.normal, scattered.direction);
            }
            direction = scattered.direction;
            hit = displaced_hit(VKFV_SCENE exposure, origin, direction);
            if (hit.found == 0u && delta) {
                query.position = origin;
                query.direction = direction;
                query.weight = throughput;
                value = value + collect(VKFV_SCENE instrument, backward, plane, specimen, exposure, query);
            }
            under_way = hit.found == 1u && dot(direction, hit.normal) < real(0.0);
        }
        VKFV_LEAVE_IF(!under_way);
    }
    return value;
}

// Sums of values are counted in units of 2^-36: a path's rounding error is below 2^-37, and 2^24 paths of value 8 fit
// into 64 bits with a bit to spare.
const real BACKWARD_UNIT = real(68719476736.0);
