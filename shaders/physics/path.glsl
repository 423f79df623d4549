// Forward paths in two halves: from the source to light that leaves the specimen, and from the specimen to a pixel.

#ifdef __cplusplus
template <class Scene>
Hit specimen_hit(const Scene& scene, real3 origin, real3 direction) {
    return scene.specimen_hit(origin, direction);
}
template <class Scene>
EmissionCell emission_cell(const Scene& scene, uvec2 path) {
    return scene.emission_cell(path);
}
#else
Hit specimen_hit(real3 origin, real3 direction); // device/specimen_hit.glsl
EmissionCell emission_cell(uvec2 path);          // device/emission_cell.glsl
#endif

// Lateral displacement by which the stage holds the specimen beside its place, mm. Rays keep to the specimen frame of a
// true stage.
VKFV_FUNCTION real3 displacement(Exposure exposure) { return real3(exposure.beside_x, exposure.beside_y, real(0.0)); }

VKFV_SCENE_FUNCTION VKFV_FUNCTION Hit displaced_hit(VKFV_SCENE_PARAMETER Exposure exposure, real3 origin,
                                                    real3 direction) {
    Hit hit = specimen_hit(VKFV_SCENE origin - displacement(exposure), direction);
    hit.position = hit.position + displacement(exposure);
    return hit;
}

VKFV_FUNCTION Fate make_fate(uint status, int surface) {
    Fate fate;
    fate.status = status;
    fate.surface = surface;
    return fate;
}

// Index of the ledger's slot for a fate: the statuses without a surface first, then those of each surface.
VKFV_FUNCTION int ledger_slot(Fate fate) {
    return fate.surface < 0
               ? int(fate.status)
               : PATH_STATUS_COUNT + SURFACE_STATUS_COUNT * fate.surface + int(fate.status - PATH_VIGNETTED);
}

// Start of scattered light: the hit point moved along the normal by eight rounding steps (2^-23) of the largest
// coordinate. The point lies off its facet by a few such steps, which a fixed offset could not know; at 1 mm it is
// moved by 1 nm.
VKFV_FUNCTION real3 scatter_origin(Hit hit) {
    real largest = max(max(abs(hit.position.x), abs(hit.position.y)), abs(hit.position.z));
    return hit.position + hit.normal * (largest * real(9.5367431640625e-7));
}

// True if light that leaves the specimen could still reach the detector: the acceptance bound, a conservative test (see
// Instrument). direction: unit.
VKFV_FUNCTION bool passes_gate(Instrument instrument, real top, real3 position, real3 direction) {
    real rise = top - position.z;
    real x = instrument.gate_position * (position.x * direction.z + direction.x * rise) +
             instrument.gate_slope * direction.x;
    real y = instrument.gate_position * (position.y * direction.z + direction.y * rise) +
             instrument.gate_slope * direction.y;
    real radius = instrument.gate_radius * direction.z;
    return direction.z > real(0.0) && x * x + y * y <= radius * radius;
}

// Light at the specimen's top plane (specimen frame) on its way down, or the reason why it ended before.
struct Arrival {
    Fate fate;       // PATH_ALIVE: the light arrived
    real3 position;  // on the plane z = top
    real3 direction; // unit
    Light light;
};

// Flight from the illumination train's last vertex to the specimen's top plane, whose z becomes 0.
VKFV_FUNCTION Ray fly_to_top(Ray ray, Exposure exposure, real index) {
    Ray top = fly_to_plane(ray, exposure.top_distance, index);
    real rest = exposure.top_distance_residual / top.direction.z;
    top.position = real3(top.position.x + rest * top.direction.x, top.position.y + rest * top.direction.y, real(0.0));
    return top;
}

// Rise from the height z in the specimen frame to the plane at z = -top_distance in front of the imaging train, mm.
VKFV_FUNCTION real rise_to_top(SpecimenRecord specimen, Exposure exposure, real z) {
    return specimen.top - z + exposure.top_distance_residual;
}

VKFV_FUNCTION real specimen_medium_index(Instrument instrument, Light light) {
    return instrument.specimen_index + disperse(instrument.specimen_dispersion, light.spectral);
}

// Light as it leaves the source.
struct Emission {
    Ray ray; // in the source's frame (a ring light's: its aim at the origin), unit direction
    Light light;
};

VKFV_SCENE_FUNCTION VKFV_FUNCTION Emission emit(VKFV_SCENE_PARAMETER Instrument instrument, Draws draws) {
    uint present = features(VKFV_SCENE_ALONE);
    Emission emission;
    emission.light = light_of_spectral(instrument, real(0.0));
    if ((present & FEATURE_SPECTRUM) != 0u) {
        emission.light = draw_light(VKFV_SCENE instrument, draws.u4);
    }
    emission.light.survival = draws.u5;
    if ((present & FEATURE_RING) != 0u) {
        emission.ray =
            emit_from_ring(instrument.ring, instrument.emission_sine, draws.u0, draws.u1, draws.u2, draws.u3);
    } else if ((present & FEATURE_RECTANGLE) != 0u) {
        emission.ray =
            emit_from_rectangle(instrument.source_half_width, instrument.source_half_height, instrument.emission_sine,
                                instrument.emission_shift, draws.u0, draws.u1, draws.u2, draws.u3);
    } else {
        emission.ray = emit_from_disc(instrument.source_radius, instrument.emission_sine, instrument.emission_shift,
                                      draws.u0, draws.u1, draws.u2, draws.u3);
    }
    if ((present & FEATURE_AIMED_RECTANGLE) != 0u) {
        real2 middle = real2(emission.ray.position.x, emission.ray.position.y) * instrument.emission_shift;
        real2 half_sides = real2(instrument.emission_half_width, instrument.emission_half_height);
        emission.ray.direction = direction_in_rectangle(middle, half_sides, draws.u2, draws.u3);
    }
    return emission;
}

// Passes light through the illumination to some plane behind it. ray: in the frame of its first vertex.
VKFV_SCENE_FUNCTION VKFV_FUNCTION TrainResult pass_illumination(VKFV_SCENE_PARAMETER Instrument instrument, Ray ray,
                                                                real index, Light light) {
    TrainResult train = enter_train(ray, index);
    bool known = false;
#ifdef VKFV_POLYNOMIALS
    if (known_edges >= 0) {
        PolynomialPassage passage = pass_by_polynomials(known_illumination(), ray, instrument.specimen_index);
        train.ray = passage.ray;
        train.status = passage.status;
        train.surface = passage.surface < 0 ? -1 : instrument.illumination_first + passage.surface;
        known = passage.known;
    }
#endif
    if (!known) {
        train = trace_short_train(VKFV_SCENE instrument.illumination_first, instrument.illumination_count, ray, index,
                                  light, SHORT_TRAIN_PLAIN);
    }
    return train;
}

// The light with which a path leaves the source.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Emission emit_path(VKFV_SCENE_PARAMETER Instrument instrument, Exposure exposure,
                                                     uvec2 path) {
    return emit(VKFV_SCENE instrument,
                draw_in_cell(exposure.seed, exposure.image, path, emission_cell(VKFV_SCENE path)));
}

VKFV_SCENE_FUNCTION VKFV_FUNCTION Arrival illuminate(VKFV_SCENE_PARAMETER Instrument instrument,
                                                     SpecimenRecord specimen, Exposure exposure, Emission emission) {
    Arrival arrival;
    arrival.light = emission.light;
    Ray ray = emission.ray;
    bool is_ring = (features(VKFV_SCENE_ALONE) & FEATURE_RING) != 0u;
    ray.position.z = ray.position.z + (is_ring ? instrument.ring.aim_distance : -instrument.source_distance);
    // The disc stands in air; the ring stands in the specimen's medium, which is on both sides of a cover glass.
    real specimen_index = specimen_medium_index(instrument, arrival.light);
    real index = is_ring ? specimen_index : real(1.0);
    ray.direction = ray.direction * index;
    TrainResult train = pass_illumination(VKFV_SCENE instrument, ray, index, arrival.light);
    Ray down = fly_to_top(train.ray, exposure, specimen_index);
    arrival.fate = make_fate(train.status, train.surface);
    // The specimen frame is the illumination's turned by half a turn about x.
    real scale = real(1.0) / specimen_index;
    arrival.position = real3(down.position.x, -down.position.y, specimen.top);
    arrival.direction = real3(down.direction.x * scale, -down.direction.y * scale, -down.direction.z * scale);
    return arrival;
}

// The result of the first half of a path.
struct Departure {
    Fate fate; // fate of its own light; PATH_ALIVE: the survivor stands for it
    bool survives;
    Survivor survivor;
};

// Directed scatter: light that a bounce scatters into the pupil's gate has two samples. One is the path's own
// direction, of density p (the chosen lobe's); the other is aimed at the gate, uniform in its slopes, of density q.
// Each has the weight p / (p + q), the balance heuristic of E. Veach and L. J. Guibas, SIGGRAPH 95, 419. Since
//   E[sum] = integral over the gate of p p / (p + q) + q p / (p + q) = integral over the gate of p,
// the expected light through the gate is that of analog scatter. The path goes on by its own direction: if it leaves
// outside the gate, or meets the specimen again before the last bounce, its light is counted, or scattered on, in full
// as in the analog form. So an aimed sample that turns out to meet the specimen again counts nowhere, except after the
// last bounce, whose light no other sample carries. A delta has no density: it is never aimed at, and its own light has
// the weight 1. Of all samples of a path one survives, with a probability proportional to its weight, and its weight
// becomes the sum of all weights, at most max_bounces + 1: the expectation stays the same.
struct GateDisc {
    real2 centre; // slopes x/z and y/z in the middle of those that pass the gate
    real radius;
};

VKFV_FUNCTION GateDisc gate_disc(Instrument instrument, real top, real3 position) {
    real scale = real(1.0) / (instrument.gate_slope + instrument.gate_position * (top - position.z));
    GateDisc disc;
    disc.centre = real2(position.x, position.y) * (-instrument.gate_position * scale);
    disc.radius = instrument.gate_radius * abs(scale);
    return disc;
}

VKFV_FUNCTION real3 direction_in_disc(GateDisc disc, real u0, real u1) {
    Turn turn = turn_of(u1);
    real rho = disc.radius * sqrt(u0);
    real x = disc.centre.x + rho * turn.cosine;
    real y = disc.centre.y + rho * turn.sine;
    real z = real(1.0) / sqrt(real(1.0) + x * x + y * y);
    return real3(x * z, y * z, z);
}

VKFV_FUNCTION bool within_disc(GateDisc disc, real3 direction) {
    real x = direction.x - disc.centre.x * direction.z;
    real y = direction.y - disc.centre.y * direction.z;
    real radius = disc.radius * direction.z;
    return direction.z > real(0.0) && x * x + y * y <= radius * radius;
}

// The ratio p / q for a direction within the gate; d(omega) = z^3 d(slopes). 0 for a delta.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real density_ratio(VKFV_SCENE_PARAMETER Lobe lobe, Incidence incidence, GateDisc disc,
                                                     real3 direction) {
    real density = lobe_bsdf(VKFV_SCENE lobe, incidence, direction) * max(dot(direction, incidence.normal), real(0.0));
    return density * (real(3.14159265358979324) * disc.radius * disc.radius) *
           (direction.z * direction.z * direction.z);
}

// The last scatter of a path, of which only light that passes the gate is seen. Instead of a direction drawn from the
// lobe by rejection, one is drawn uniform in the slopes of the gate's disc, of density q, and accepted with probability
// p / q. This is exact where p / q is nowhere above 1: the light passes with the probability that is the integral of p
// over the gate, and passing directions have the density p. All other light has escaped; mostly that is known from a
// bound of p alone. Where the bound exceeds 1, near the middle of a sharp lobe, the direction is drawn from the lobe
// within the least cone about the mirror direction that holds the gate, with the p / q of that draw.
struct GatedScatter {
    bool applies; // false: both bounds exceed 1, or the model has none
    bool passes;
    real3 direction;
};

VKFV_SCENE_FUNCTION VKFV_FUNCTION GatedScatter scatter_into_gate(VKFV_SCENE_PARAMETER Lobe lobe, Incidence incidence,
                                                                 GateDisc disc, real u0, real u1, real u2) {
    // Unit directions are no further apart than their slopes, so distances of slopes are scaled to bounds of these.
    real scale = inversesqrt(real(1.0) + disc.centre.x * disc.centre.x + disc.centre.y * disc.centre.y);
    real3 off = real3(disc.centre.x * scale, disc.centre.y * scale, scale) - incidence.mirror;
    real to_centre = sqrt(dot(off, off));
    real apart = max(to_centre - disc.radius, real(0.0));
    real area = real(3.14159265358979324) * disc.radius * disc.radius;
    real ceiling = lobe_ceiling(lobe, incidence, apart) * area;
    GatedScatter result;
    bool from_above = dot(incidence.incoming, incidence.normal) < real(0.0);
    result.applies = from_above && ceiling > real(0.0) && ceiling <= real(1.0);
    result.passes = false;
    result.direction = incidence.mirror;
    if (result.applies && u2 < ceiling) {
        result.direction = direction_in_disc(disc, u0, u1);
        result.passes = u2 < density_ratio(VKFV_SCENE lobe, incidence, disc, result.direction);
    }
    if (from_above && ceiling > real(1.0)) {
        real chord = to_centre + disc.radius;
        ConeDraw cone = lobe_cone(lobe, incidence, min(real(0.5) * chord * chord, real(2.0)), u0, u1);
        result.applies = cone.bound > real(0.0) && cone.bound <= real(1.0);
        result.direction = cone.direction;
        result.passes = result.applies && u2 < cone.ratio && within_disc(disc, cone.direction);
    }
    return result;
}

#ifdef __cplusplus
inline real density_ratio(Lobe lobe, Incidence incidence, GateDisc disc, real3 direction) {
    return density_ratio(NoNumbers{}, lobe, incidence, disc, direction);
}
inline GatedScatter scatter_into_gate(Lobe lobe, Incidence incidence, GateDisc disc, real u0, real u1, real u2) {
    return scatter_into_gate(NoNumbers{}, lobe, incidence, disc, u0, u1, u2);
}
#endif

struct Selection {
    real weight; // sum of the weights of all samples so far
    Survivor survivor;
};

VKFV_FUNCTION Selection offer(Selection selection, real weight, real3 position, real3 direction, uint mark, real u) {
    selection.weight = selection.weight + weight;
    if (u * selection.weight < weight) {
        selection.survivor.position = position;
        selection.survivor.direction_x = direction.x;
        selection.survivor.direction_y = direction.y;
        selection.survivor.mark = mark;
    }
    return selection;
}

VKFV_FUNCTION uint survivor_weight(Survivor survivor) { return survivor.mark >> SURVIVOR_WEIGHT_BIT; }

VKFV_FUNCTION uint weight_beside(Survivor survivor) {
    return (survivor.mark & SURVIVOR_BESIDE) != 0u ? WEIGHT_ONE : 0u;
}

// The square of a path's total weight in the ledger, in units of 2^-18: below 2^31, as no weight exceeds 66.
VKFV_FUNCTION uint weight_square(uint weight) {
    return (multiply_high(weight, weight) << 6) | ((weight * weight) >> 26);
}

// Scatter at the specimen until the light leaves it. Before the last permitted bounce every ray is tested against
// the specimen; on the last one the gate comes first and the test is left to the second half.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Departure scatter_at_specimen(VKFV_SCENE_PARAMETER Instrument instrument,
                                                                SpecimenRecord specimen, Exposure exposure, uvec2 path,
                                                                real3 origin, real3 direction, Light light) {
    bool directed = (features(VKFV_SCENE_ALONE) & FEATURE_DIRECTED_SCATTER) != 0u;
    uint status = PATH_ALIVE;
    uint mark = 0u;
    Selection selection;
    selection.weight = real(0.0);
    selection.survivor.position = origin;
    selection.survivor.direction_x = real(0.0);
    selection.survivor.direction_y = real(0.0);
    selection.survivor.mark = 0u;
    real own_share = real(1.0);
    real own_choice = real(0.0);
    Hit hit = displaced_hit(VKFV_SCENE exposure, origin, direction);
    status = hit.found == 1u ? PATH_ALIVE : PATH_OFF_SPECIMEN;
    bool under_way = hit.found == 1u;
    for (int bounce = 0; bounce < specimen.max_bounces && under_way; ++bounce) {
        uint first_block = 1u + uint(bounce) * SCATTER_BLOCKS;
        bool last = bounce + 1 == specimen.max_bounces;
        Incidence incidence = make_incidence(direction, hit.normal);
        Material material =
            material_of_light(VKFV_SCENE instrument, specimen,
                              material_at(VKFV_SCENE specimen, hit.position - displacement(exposure)), light);
        origin = scatter_origin(hit);
        GatedScatter gated;
        gated.applies = false;
        if (last && !directed) {
            Draws draws = draw(exposure.seed, exposure.image, path, first_block);
            gated = scatter_into_gate(VKFV_SCENE scattering_lobe(material, draws), incidence,
                                      gate_disc(instrument, specimen.top, origin), draws.u0, draws.u1, draws.u2);
        }
        Scattered scattered = scatter_by_tries(VKFV_SCENE material, incidence, exposure.seed, exposure.image, path,
                                               first_block, gated.applies ? 0u : SCATTER_BLOCKS - 1u);
        direction = gated.applies ? gated.direction : scattered.direction;
        under_way = gated.applies ? gated.passes : scattered.accepted;
        status = under_way            ? PATH_ALIVE
                 : gated.applies      ? PATH_ESCAPED
                 : scattered.absorbed ? PATH_ABSORBED
                                      : PATH_NUMERICAL;
        // Light that a lossy lobe absorbs is of its own direction alone.
        bool lobe_lost = scattered.absorbed && scattered.lobe.model != SCATTER_NONE;
        if (directed && (under_way || lobe_lost)) {
            Draws draws = draw(exposure.seed, exposure.image, path, first_block + SCATTER_BLOCKS - 1u);
            GateDisc disc = gate_disc(instrument, specimen.top, origin);
            real3 aimed = direction_in_disc(disc, draws.u0, draws.u1);
            real ratio = density_ratio(VKFV_SCENE scattered.lobe, incidence, disc, aimed);
            selection = offer(selection, ratio / (real(1.0) + ratio), origin, aimed,
                              last ? SURVIVOR_TO_TEST : SURVIVOR_TO_TEST | SURVIVOR_TWIN, draws.u2);
            real own_ratio = density_ratio(VKFV_SCENE scattered.lobe, incidence, disc, direction);
            own_share = own_ratio > real(0.0) ? own_ratio / (real(1.0) + own_ratio) : real(1.0);
            own_choice = draws.u3;
        }
        if (last) {
            mark = SURVIVOR_TO_TEST;
            under_way = false;
        } else if (under_way) {
            hit = displaced_hit(VKFV_SCENE exposure, origin, direction);
            under_way = hit.found == 1u;
        }
        VKFV_LEAVE_IF(!under_way);
    }
    if (status == PATH_ALIVE && !passes_gate(instrument, specimen.top, origin, direction)) {
        status = PATH_ESCAPED;
    }
    Departure departure;
    departure.fate = make_fate(status, -1);
    departure.survives = status == PATH_ALIVE;
    departure.survivor.position = origin;
    departure.survivor.direction_x = direction.x;
    departure.survivor.direction_y = direction.y;
    departure.survivor.mark = mark;
    if (directed) {
        if (status == PATH_ALIVE) {
            selection = offer(selection, own_share, origin, direction, mark, own_choice);
        }
        uint weight = uint(selection.weight * real(WEIGHT_ONE) + real(0.5));
        departure.survives = weight > 0u;
        departure.survivor = selection.survivor;
        departure.survivor.mark =
            selection.survivor.mark | (weight << SURVIVOR_WEIGHT_BIT) | (status == PATH_ALIVE ? 0u : SURVIVOR_BESIDE);
    }
    departure.survivor.spectral = real(0.0);
    departure.survivor.survival = real(0.0);
    return departure;
}

VKFV_SCENE_FUNCTION VKFV_FUNCTION Departure trace_to_departure(VKFV_SCENE_PARAMETER Instrument instrument,
                                                               SpecimenRecord specimen, Exposure exposure, uvec2 path) {
    Arrival arrival =
        illuminate(VKFV_SCENE instrument, specimen, exposure, emit_path(VKFV_SCENE instrument, exposure, path));
    Departure departure;
    departure.fate = arrival.fate;
    departure.survives = false;
    if (arrival.fate.status == PATH_ALIVE) {
        departure = scatter_at_specimen(VKFV_SCENE instrument, specimen, exposure, path, arrival.position,
                                        arrival.direction, arrival.light);
        departure.survivor.spectral = arrival.light.spectral;
        if ((features(VKFV_SCENE_ALONE) & FEATURE_LOSSES) != 0u) {
            // The draw is from the block after those of the last scatter event.
            Draws draws = draw(exposure.seed, exposure.image, path, 1u + uint(specimen.max_bounces) * SCATTER_BLOCKS);
            departure.survivor.survival = draws.u0;
        }
    }
    return departure;
}

// The result of the second half of a path: its place on the detector.
struct Detection {
    Fate fate; // PATH_DETECTED comes with a pixel; PATH_ALIVE: a twin, not to be counted
    int column;
    int row;
    real x; // mm, on the detector's plane, axes parallel to the specimen's, inversion not removed
    real y;
    real2 slope;    // slopes dx/dz and dy/dz at this place
    real2 recorded; // mm, the place that the pixels stand for (image_distortion.glsl)
};

VKFV_FUNCTION real3 survivor_direction(Survivor survivor) {
    real axial = real(1.0) - survivor.direction_x * survivor.direction_x - survivor.direction_y * survivor.direction_y;
    return real3(survivor.direction_x, survivor.direction_y, sqrt(max(axial, real(0.0))));
}

// True if the light meets the specimen again: the test that the first half left out.
VKFV_SCENE_FUNCTION VKFV_FUNCTION bool survivor_occluded(VKFV_SCENE_PARAMETER Exposure exposure, Survivor survivor) {
    bool occluded = false;
    if ((survivor.mark & SURVIVOR_TO_TEST) != 0u) {
        Hit hit = displaced_hit(VKFV_SCENE exposure, survivor.position, survivor_direction(survivor));
        occluded = hit.found == 1u;
    }
    return occluded;
}

// The pixel on which light lands. x, y: mm, on the detector's plane, axes parallel to the specimen's, inversion not
// removed.
VKFV_FUNCTION Detection detect(Instrument instrument, Exposure exposure, real x, real y) {
    real half_width = instrument.detector_half_width;
    real half_height = instrument.detector_half_height;
    // The inversion is removed: a negative magnification turns the image by half a turn.
    real turn = instrument.magnification < real(0.0) ? real(-1.0) : real(1.0);
    real scale = real(instrument.detector_columns) / (real(2.0) * half_width);
    real2 recorded = recorded_place(instrument, exposure, real2(x, y));
    bool on_detector = abs(recorded.x) < half_width && abs(recorded.y) < half_height;
    bool finite = !(isnan(x) || isinf(x) || isnan(y) || isinf(y));
    Detection detection;
    detection.x = x;
    detection.y = y;
    detection.slope = real2(real(0.0), real(0.0));
    detection.recorded = recorded;
    real column = (turn * recorded.x + half_width) * scale;
    real row = (turn * recorded.y + half_height) * scale;
    detection.column = on_detector ? clamp(int(floor(column)), 0, instrument.detector_columns - 1) : 0;
    detection.row = on_detector ? clamp(int(floor(row)), 0, instrument.detector_rows - 1) : 0;
    // Light between the sensitive parts of the pixels is off the detector too.
    on_detector = on_detector && abs(column - real(detection.column) - real(0.5)) <= instrument.pixel_reach &&
                  abs(row - real(detection.row) - real(0.5)) <= instrument.pixel_reach;
    detection.fate = make_fate(!finite ? PATH_NUMERICAL : on_detector ? PATH_DETECTED : PATH_OFF_DETECTOR, -1);
    return detection;
}

VKFV_SCENE_FUNCTION VKFV_FUNCTION Detection image_survivor(VKFV_SCENE_PARAMETER Instrument instrument,
                                                           SpecimenRecord specimen, Exposure exposure,
                                                           Survivor survivor) {
    real3 direction = survivor_direction(survivor);
    bool occluded = survivor_occluded(VKFV_SCENE exposure, survivor);
    // The ray starts on the top plane, whose distance to the front vertex is known in double.
    real rise = rise_to_top(specimen, exposure, survivor.position.z) / direction.z;
    Ray ray;
    ray.position = real3(survivor.position.x + rise * direction.x, survivor.position.y + rise * direction.y,
                         -exposure.top_distance);
    Light light = light_of_spectral(instrument, survivor.spectral);
    light.survival = survivor.survival;
    real index = specimen_medium_index(instrument, light);
    ray.direction = direction * index;
    ray.path_length = real(0.0);
    TrainResult train = trace_short_train(VKFV_SCENE instrument.imaging_first, instrument.imaging_count, ray, index,
                                          light, SHORT_TRAIN_FINE);
    Ray arrived = fly_to_plane(train.ray, instrument.detector_distance, train.index);
    Detection detection = detect(instrument, exposure, arrived.position.x, arrived.position.y);
    detection.slope = real2(arrived.direction.x, arrived.direction.y) / arrived.direction.z;
    bool twin = (survivor.mark & SURVIVOR_TWIN) != 0u;
    detection.fate = occluded                     ? make_fate(twin ? PATH_ALIVE : PATH_BOUNCE_LIMIT, -1)
                     : train.status != PATH_ALIVE ? make_fate(train.status, train.surface)
                                                  : detection.fate;
    return detection;
}

// The pupil cell and pixel part that detected light is sorted to.
VKFV_FUNCTION CellPlace detection_place(Instrument instrument, PupilCells cells, Detection detection) {
    real turn = instrument.magnification < real(0.0) ? real(-1.0) : real(1.0);
    real scale = real(instrument.detector_columns) / (real(2.0) * instrument.detector_half_width);
    real column = (turn * detection.recorded.x + instrument.detector_half_width) * scale - real(detection.column);
    real row = (turn * detection.recorded.y + instrument.detector_half_height) * scale - real(detection.row);
    CellPlace place;
    place.column = detection.column * int(cells.parts) + pixel_part(cells, column);
    place.row = detection.row * int(cells.parts) + pixel_part(cells, row);
    place.cell = pupil_cell(cells, detection.slope - chief_slope(cells, real2(detection.x, detection.y)));
    return place;
}
