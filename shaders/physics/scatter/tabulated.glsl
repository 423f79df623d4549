// A measured isotropic BSDF by the angle of incidence, the angle of scatter, and the azimuth between the outgoing
// direction and the mirror direction's (0 to 180 degrees, the same on either side). The host reads, checks and prepares
// it in src/specimen/tabulated_bsdf.cpp. It is linear between its angles; its integral of f cos(theta) over the
// hemisphere is the share that is scattered, and the rest is absorbed. It is as reciprocal as its table.
// absorbs
// table
// drawn_by_table
// numbers

// Places of a table's numbers: its angles (rad), for each incidence the share that is kept and the mass of the
// proposals, the values f[incidence][scatter][azimuth], and for each incidence and cell [scatter][azimuth] the
// cumulative mass of the proposals up to and including this cell, as a share of all.
struct TabulatedLayout {
    int incidences; // number of points of each angle, at least 2
    int scatters;
    int azimuths;
    int first_incidence; // places of the first number of each kind
    int first_scatter;
    int first_azimuth;
    int first_kept;
    int first_proposed;
    int first_value;
    int first_cumulative;
};

VKFV_FUNCTION TabulatedLayout tabulated_layout(real table[LOBE_TABLE_SIZE]) {
    TabulatedLayout places;
    places.incidences = int(table[1]);
    places.scatters = int(table[2]);
    places.azimuths = int(table[3]);
    places.first_incidence = int(table[0]);
    places.first_scatter = places.first_incidence + places.incidences;
    places.first_azimuth = places.first_scatter + places.scatters;
    places.first_kept = places.first_azimuth + places.azimuths;
    places.first_proposed = places.first_kept + places.incidences;
    places.first_value = places.first_proposed + places.incidences;
    places.first_cumulative = places.first_value + places.incidences * places.scatters * places.azimuths;
    return places;
}

// A place between two points of an ascending list.
struct TabulatedPlace {
    int point;
    real share; // fraction of the way to the next point
};

VKFV_SCENE_FUNCTION VKFV_FUNCTION TabulatedPlace tabulated_place(VKFV_SCENE_PARAMETER int begin, int points,
                                                                 real value) {
    int first = 0;
    int last = points - 1;
    while (last - first > 1) {
        int middle = (first + last) / 2;
        if (value < material_number(VKFV_SCENE begin + middle)) {
            last = middle;
        } else {
            first = middle;
        }
    }
    real start = material_number(VKFV_SCENE begin + first);
    real stop = material_number(VKFV_SCENE begin + first + 1);
    TabulatedPlace place;
    place.point = first;
    place.share = clamp((value - start) / (stop - start), real(0.0), real(1.0));
    return place;
}

// The BSDF at these angles of scatter and azimuth, for the incidence-th angle of incidence of the table.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real tabulated_value(VKFV_SCENE_PARAMETER TabulatedLayout places, int incidence,
                                                       TabulatedPlace scatter, TabulatedPlace azimuth) {
    int corner = places.first_value + (incidence * places.scatters + scatter.point) * places.azimuths + azimuth.point;
    int beyond = corner + places.azimuths;
    real lower = mix(material_number(VKFV_SCENE corner), material_number(VKFV_SCENE corner + 1), azimuth.share);
    real upper = mix(material_number(VKFV_SCENE beyond), material_number(VKFV_SCENE beyond + 1), azimuth.share);
    return mix(lower, upper, scatter.share);
}

// Largest value at the corners of a cell.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real tabulated_ceiling(VKFV_SCENE_PARAMETER TabulatedLayout places, int incidence,
                                                         int scatter, int azimuth) {
    int corner = places.first_value + (incidence * places.scatters + scatter) * places.azimuths + azimuth;
    int beyond = corner + places.azimuths;
    return max(max(material_number(VKFV_SCENE corner), material_number(VKFV_SCENE corner + 1)),
               max(material_number(VKFV_SCENE beyond), material_number(VKFV_SCENE beyond + 1)));
}

VKFV_FUNCTION real3 tabulated_along(real3 direction, real3 normal) {
    return direction - normal * dot(direction, normal);
}

// The angle between a direction and the normal, rad.
VKFV_FUNCTION real tabulated_angle(real3 direction, real3 normal) {
    real3 along = tabulated_along(direction, normal);
    return atan(sqrt(dot(along, along)), dot(direction, normal));
}

// The unit vectors along the surface, in the plane of incidence and across it.
VKFV_FUNCTION Frame tabulated_frame(Incidence incidence) {
    Frame frame = frame_around(incidence.normal);
    real3 along = tabulated_along(incidence.incoming, incidence.normal);
    real length_squared = dot(along, along);
    if (length_squared > real(0.0)) {
        real3 n = incidence.normal;
        real3 first = along * (real(1.0) / sqrt(length_squared));
        frame.first = first;
        frame.second =
            real3(n.y * first.z - n.z * first.y, n.z * first.x - n.x * first.z, n.x * first.y - n.y * first.x);
    }
    return frame;
}

// Proposes a cell with the mass of its largest value over it, and a direction in it with constant density per projected
// solid angle.
VKFV_SCENE_FUNCTION VKFV_FUNCTION ScatterTry tabulated_try(VKFV_SCENE_PARAMETER real table[LOBE_TABLE_SIZE],
                                                           Incidence incidence, real u0, real u1, real u2) {
    TabulatedLayout places = tabulated_layout(table);
    TabulatedPlace row = tabulated_place(VKFV_SCENE places.first_incidence, places.incidences,
                                         tabulated_angle(-incidence.incoming, incidence.normal));
    real below = (real(1.0) - row.share) * material_number(VKFV_SCENE places.first_proposed + row.point);
    real beyond = row.share * material_number(VKFV_SCENE places.first_proposed + row.point + 1);
    real kept = mix(material_number(VKFV_SCENE places.first_kept + row.point),
                    material_number(VKFV_SCENE places.first_kept + row.point + 1), row.share);
    real place = u2 * (below + beyond + max(real(1.0) - kept, real(0.0)));
    bool of_beyond = place >= below;
    ScatterTry result;
    result.absorbed = place >= below + beyond;
    int chosen = row.point + (of_beyond && !result.absorbed ? 1 : 0);
    real rest = clamp(of_beyond ? (place - below) / max(beyond, real(1e-30)) : place / max(below, real(1e-30)),
                      real(0.0), real(1.0));
    int cells_across = places.azimuths - 1;
    int cells = (places.scatters - 1) * cells_across;
    int begin = places.first_cumulative + chosen * cells;
    int first = 0;
    int last = cells - 1;
    while (first < last) {
        int middle = (first + last) / 2;
        if (u0 <= material_number(VKFV_SCENE begin + middle)) {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    real before = real(0.0);
    if (first > 0) {
        before = material_number(VKFV_SCENE begin + first - 1);
    }
    real across = clamp((u0 - before) / max(material_number(VKFV_SCENE begin + first) - before, real(1e-30)), real(0.0),
                        real(1.0));
    TabulatedPlace scatter;
    scatter.point = first / cells_across;
    TabulatedPlace azimuth;
    azimuth.point = first - scatter.point * cells_across;
    // The share across serves both sides of the plane of incidence.
    azimuth.share = abs(real(2.0) * across - real(1.0));
    real side = across < real(0.5) ? real(-1.0) : real(1.0);
    real start = material_number(VKFV_SCENE places.first_scatter + scatter.point);
    real stop = material_number(VKFV_SCENE places.first_scatter + scatter.point + 1);
    // The squared sine is uniform between those of both ends; their difference is formed without cancellation.
    real low = sin(start);
    real sine = sqrt(low * low + u1 * sin(stop - start) * sin(stop + start));
    real cosine = sqrt(max(real(1.0) - sine * sine, real(0.0)));
    scatter.share = clamp((atan(sine, cosine) - start) / (stop - start), real(0.0), real(1.0));
    real phi = mix(material_number(VKFV_SCENE places.first_azimuth + azimuth.point),
                   material_number(VKFV_SCENE places.first_azimuth + azimuth.point + 1), azimuth.share);
    Frame frame = tabulated_frame(incidence);
    result.direction =
        incidence.normal * cosine + frame.first * (sine * cos(phi)) + frame.second * (side * sine * sin(phi));
    result.accepted = !result.absorbed && cosine > real(0.0) &&
                      rest * tabulated_ceiling(VKFV_SCENE places, chosen, scatter.point, azimuth.point) <
                          tabulated_value(VKFV_SCENE places, chosen, scatter, azimuth);
    return result;
}

VKFV_SCENE_FUNCTION VKFV_FUNCTION real tabulated_bsdf(VKFV_SCENE_PARAMETER real table[LOBE_TABLE_SIZE],
                                                      Incidence incidence, real3 outgoing) {
    TabulatedLayout places = tabulated_layout(table);
    real value = real(0.0);
    if (places.incidences > 0) {
        TabulatedPlace row = tabulated_place(VKFV_SCENE places.first_incidence, places.incidences,
                                             tabulated_angle(-incidence.incoming, incidence.normal));
        TabulatedPlace scatter = tabulated_place(VKFV_SCENE places.first_scatter, places.scatters,
                                                 tabulated_angle(outgoing, incidence.normal));
        Frame frame = tabulated_frame(incidence);
        real forth = dot(outgoing, frame.first);
        real aside = abs(dot(outgoing, frame.second));
        bool upright = forth == real(0.0) && aside == real(0.0);
        TabulatedPlace azimuth =
            tabulated_place(VKFV_SCENE places.first_azimuth, places.azimuths, atan(aside, upright ? real(1.0) : forth));
        value = mix(tabulated_value(VKFV_SCENE places, row.point, scatter, azimuth),
                    tabulated_value(VKFV_SCENE places, row.point + 1, scatter, azimuth), row.share);
    }
    return value;
}
