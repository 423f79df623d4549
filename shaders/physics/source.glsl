// Light sources, all Lambertian: uniform radiance, so that the position is uniform over the area and the direction, a
// unit vector (l, m, n), is uniform in (l, m): the unit disc is the whole hemisphere. An aimed source draws only from
// the disc of radius emission_sine about a middle; if it lies within the unit disc it holds the share emission_sine^2
// of the flux, exactly and from every point. The middle is emission_shift times the place at the source, so that light
// from all of it goes where the optics accept light from; with 0 the disc is a cone about the normal. A rectangle may
// stand in place of the disc.

// cos and sin of 2 pi u, for any u, since GLSL's own are bounded to 2^-11 alone, and beyond [-pi, pi] not at all. They
// are polynomials in r^2 for |r| <= 1/8, r the share of a turn from the nearest quarter, through the functions' values
// at Chebyshev's nodes: off by less than the rounding of a double, on devices of a float (2.4e-9).
struct Turn {
    real cosine;
    real sine;
};
VKFV_FUNCTION Turn turn_of(real u) {
    real quarters = floor(real(4.0) * u + real(0.5));
    real r = u - real(0.25) * quarters;
    real q = r * r;
#ifdef __cplusplus
    real sine = r * (real(6.2831853071795862) +
                     q * (real(-41.341702240399634) +
                          q * (real(81.60524927594804) +
                               q * (real(-76.705859704274545) +
                                    q * (real(42.058685020160894) +
                                         q * (real(-15.093804209987114) + q * real(3.7808689593022957)))))));
    real cosine = real(1.0) + q * (real(-19.739208802178421) +
                                   q * (real(64.939394022365377) +
                                        q * (real(-85.456817090341147) +
                                             q * (real(60.244620085930293) +
                                                  q * (real(-26.42425703488269) + q * real(7.8102909681441908))))));
#else
    real sine = r * (real(6.2831852878129535) +
                     q * (real(-41.34166257054848) + q * (real(81.59254287127337) + q * real(-75.40161269901384))));
    real cosine =
        real(1.0) + q * (real(-19.73920878998753) +
                         q * (real(64.93936905141686) + q * (real(-85.44882008881382) + q * real(59.424105938188575))));
#endif
    int quadrant = int(quarters);
    bool odd = (quadrant & 1) != 0;
    Turn turn;
    turn.sine = odd ? cosine : sine;
    turn.cosine = odd ? sine : cosine;
    turn.sine = (quadrant & 2) != 0 ? -turn.sine : turn.sine;
    turn.cosine = ((quadrant + 1) & 2) != 0 ? -turn.cosine : turn.cosine;
    return turn;
}

// A direction uniform over the disc of radius emission_sine about `middle` (l, m); frame of the emitting area, towards
// +z.
VKFV_FUNCTION real3 aimed_direction(real2 middle, real emission_sine, real u0, real u1) {
    real sine_squared = emission_sine * emission_sine * u0;
    real sine = sqrt(sine_squared);
    Turn psi = turn_of(u1);
    real2 beside = real2(sine * psi.cosine, sine * psi.sine);
    // |middle + beside|^2 is small, so that its difference from 1 is rounded once.
    real across_squared = sine_squared + dot(middle, middle + beside + beside);
    return real3(middle.x + beside.x, middle.y + beside.y, sqrt(max(real(1.0) - across_squared, real(0.0))));
}

// A direction uniform over a rectangle of (l, m). middle: (l, m); half_sides: of the rectangle along x and y.
VKFV_FUNCTION real3 direction_in_rectangle(real2 middle, real2 half_sides, real u0, real u1) {
    real2 beside = real2(half_sides.x * (real(2.0) * u0 - real(1.0)), half_sides.y * (real(2.0) * u1 - real(1.0)));
    real across_squared = dot(beside, beside) + dot(middle, middle + beside + beside);
    return real3(middle.x + beside.x, middle.y + beside.y, sqrt(max(real(1.0) - across_squared, real(0.0))));
}

VKFV_FUNCTION real3 lambertian_direction(real emission_sine, real u0, real u1) {
    return aimed_direction(real2(real(0.0), real(0.0)), emission_sine, u0, u1);
}

// A ray from a flat disc about the origin in z = 0.
VKFV_FUNCTION Ray emit_from_disc(real radius, real emission_sine, real emission_shift, real u0, real u1, real u2,
                                 real u3) {
    real rho = radius * sqrt(u0);
    Turn phi = turn_of(u1);
    Ray ray;
    ray.position = real3(rho * phi.cosine, rho * phi.sine, real(0.0));
    ray.direction = aimed_direction(real2(ray.position.x, ray.position.y) * emission_shift, emission_sine, u2, u3);
    ray.path_length = real(0.0);
    return ray;
}

// A ray from a flat rectangle about the origin in z = 0.
VKFV_FUNCTION Ray emit_from_rectangle(real half_width, real half_height, real emission_sine, real emission_shift,
                                      real u0, real u1, real u2, real u3) {
    Ray ray;
    ray.position =
        real3(half_width * (real(2.0) * u0 - real(1.0)), half_height * (real(2.0) * u1 - real(1.0)), real(0.0));
    ray.direction = aimed_direction(real2(ray.position.x, ray.position.y) * emission_shift, emission_sine, u2, u3);
    ray.path_length = real(0.0);
    return ray;
}

// A point of a ring light about the z axis that shines on the origin from z < 0. The ring's band lies on a cone: at w
// across the band, from the ring's inside, its radius is r - w sin(elevation), and so is its share of the area.
struct RingPoint {
    real3 position;
    real3 normal; // unit, towards the lit side
    real3 across; // unit, across the band, inwards
    real3 around;
};

VKFV_FUNCTION int segments_on(RingLight ring) {
    int on = 0;
    for (int segment = 0; segment < ring.segments; ++segment) {
        on += int((ring.switched_on >> segment) & 1u);
    }
    return on;
}

// A point uniform over the area that shines.
VKFV_FUNCTION RingPoint ring_point(RingLight ring, real u0, real u1) {
    int on = segments_on(ring);
    real scaled = u0 * real(on);
    int wanted = min(int(scaled), on - 1);
    int chosen = 0;
    int seen = 0;
    for (int segment = 0; segment < ring.segments; ++segment) {
        if (((ring.switched_on >> segment) & 1u) != 0u) {
            chosen = seen == wanted ? segment : chosen;
            seen += 1;
        }
    }
    real within = real(0.5) + ring.fill * (scaled - real(wanted) - real(0.5));
    Turn azimuth = turn_of((real(chosen) + within) / real(ring.segments));
    real radius = ring.distance * ring.elevation_cosine;
    // w is where the share of the area is u1: r (w + h) - sin (w^2 - h^2) / 2 = 2 r h u1.
    real constant =
        ring.half_width * (real(2.0) * radius * u1 - radius - real(0.5) * ring.elevation_sine * ring.half_width);
    real w = real(2.0) * constant /
             (radius + sqrt(max(radius * radius - real(2.0) * ring.elevation_sine * constant, real(0.0))));
    real rho = radius - w * ring.elevation_sine;
    // Outward and axis are in this frame, which is the specimen's turned by half a turn about x: y and z change sign.
    real3 outward = real3(azimuth.cosine, -azimuth.sine, real(0.0));
    real3 axis = real3(real(0.0), real(0.0), real(1.0));
    RingPoint point;
    point.position = outward * rho - axis * (ring.distance * ring.elevation_sine + w * ring.elevation_cosine);
    point.normal = axis * ring.elevation_sine - outward * ring.elevation_cosine;
    point.across = outward * (-ring.elevation_sine) - axis * ring.elevation_cosine;
    point.around = real3(-azimuth.sine, -azimuth.cosine, real(0.0));
    return point;
}

VKFV_FUNCTION Ray emit_from_ring(RingLight ring, real emission_sine, real u0, real u1, real u2, real u3) {
    RingPoint point = ring_point(ring, u0, u1);
    real3 direction = lambertian_direction(emission_sine, u2, u3);
    Ray ray;
    ray.position = point.position;
    ray.direction = point.normal * direction.z + point.across * direction.x + point.around * direction.y;
    ray.path_length = real(0.0);
    return ray;
}

// Area of the segments that shine, mm^2.
VKFV_FUNCTION real ring_area(RingLight ring) {
    real all = real(4.0) * real(3.14159265358979324) * ring.distance * ring.elevation_cosine * ring.half_width;
    return all * ring.fill * real(segments_on(ring)) / real(ring.segments);
}

// The meeting of a ray with the segments that shine of a ring light, from its inside.
struct RingMeeting {
    bool found;
    real distance; // mm along the ray, whose direction is a unit vector
    real cosine;   // between the ray and the band's normal
};

// The meeting in the specimen's orientation, z up, with the ring's aim at the origin. direction: unit.
VKFV_FUNCTION RingMeeting meet_ring(RingLight ring, real3 position, real3 direction) {
    // The cone is rho = r - (z - z_0) tan(elevation), so the meeting solves A t^2 + 2 B t + C = 0.
    real tangent = ring.elevation_sine / ring.elevation_cosine;
    real lift = position.z - ring.distance * ring.elevation_sine;
    real start = ring.distance * ring.elevation_cosine - lift * tangent; // the cone's radius at the ray's height
    real growth = -tangent * direction.z;
    real2 aside = real2(position.x, position.y);
    real2 along = real2(direction.x, direction.y);
    real a = dot(along, along) - growth * growth;
    real b = dot(aside, along) - start * growth;
    real c = dot(aside, aside) - start * start;
    real q = b + (b < real(0.0) ? real(-1.0) : real(1.0)) * sqrt(max(b * b - a * c, real(0.0)));
    RingMeeting meeting;
    meeting.found = false;
    meeting.distance = real(0.0);
    meeting.cosine = real(0.0);
    for (int k = 0; k < 2; ++k) {
        real t = k == 0 ? -q / a : -c / q;
        real radius = start + growth * t;
        real w = (lift + t * direction.z) / ring.elevation_cosine;
        real2 outward = (aside + along * t) / radius;
        real cosine = dot(outward, along) * ring.elevation_cosine + direction.z * ring.elevation_sine;
        bool on_band = t > real(0.0) && radius > real(0.0) && abs(w) <= ring.half_width && cosine > real(0.0);
        real turns = atan(outward.y, outward.x) * real(0.15915494309189534);
        real place = (turns < real(0.0) ? turns + real(1.0) : turns) * real(ring.segments);
        int segment = clamp(int(place), 0, ring.segments - 1);
        bool shines = ((ring.switched_on >> segment) & 1u) != 0u &&
                      abs(place - real(segment) - real(0.5)) <= real(0.5) * ring.fill;
        if (on_band && shines && !meeting.found) {
            meeting.found = true;
            meeting.distance = t;
            meeting.cosine = cosine;
        }
    }
    return meeting;
}
