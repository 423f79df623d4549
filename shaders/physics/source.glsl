// Light sources, all Lambertian: uniform radiance, so position is uniform over the area and the direction has the
// density cos(theta) / (pi sin^2(theta_max)) within the cone sin(theta) <= emission_sine about the normal: the unit
// disc of (l, m), scaled. With emission_sine = 1 this is the whole hemisphere; less aims at a cone, which holds the
// share emission_sine^2 of the flux, exactly and from every point. Directions are unit vectors.

// cos and sin of 2 pi u, for any u: GLSL's own are bounded to 2^-11 alone, and beyond [-pi, pi] not at all. Polynomials
// in r^2 for |r| <= 1/8, r the share of a turn from the nearest quarter, through the functions' values at Chebyshev's
// nodes: off by less than double's rounding.
struct Turn {
    real cosine;
    real sine;
};
VKFV_FUNCTION Turn turn_of(real u) {
    real quarters = floor(real(4.0) * u + real(0.5));
    real r = u - real(0.25) * quarters;
    real q = r * r;
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
    int quadrant = int(quarters);
    bool odd = (quadrant & 1) != 0;
    Turn turn;
    turn.sine = odd ? cosine : sine;
    turn.cosine = odd ? sine : cosine;
    turn.sine = (quadrant & 2) != 0 ? -turn.sine : turn.sine;
    turn.cosine = ((quadrant + 1) & 2) != 0 ? -turn.cosine : turn.cosine;
    return turn;
}

// In the frame of the emitting area, towards +z.
VKFV_FUNCTION real3 lambertian_direction(real emission_sine, real u0, real u1) {
    real sine_squared = emission_sine * emission_sine * u0;
    real sine = sqrt(sine_squared);
    Turn psi = turn_of(u1);
    return real3(sine * psi.cosine, sine * psi.sine, sqrt(real(1.0) - sine_squared));
}

// A flat disc about the origin in z = 0.
VKFV_FUNCTION Ray emit_from_disc(real radius, real emission_sine, real u0, real u1, real u2, real u3) {
    real rho = radius * sqrt(u0);
    Turn phi = turn_of(u1);
    Ray ray;
    ray.position = real3(rho * phi.cosine, rho * phi.sine, real(0.0));
    ray.direction = lambertian_direction(emission_sine, u2, u3);
    ray.path_length = real(0.0);
    return ray;
}

// A ring light about the z axis that shines on the origin from z < 0. Its band lies on a cone: at w across the band,
// from the ring's inside, its radius is r - w sin(elevation), and so is its share of the area.
VKFV_FUNCTION Ray emit_from_ring(RingLight ring, real emission_sine, real u0, real u1, real u2, real u3) {
    int on = 0;
    for (int segment = 0; segment < ring.segments; ++segment) {
        on += int((ring.switched_on >> segment) & 1u);
    }
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
    // The w whose share of the area is u1: r (w + h) - sin (w^2 - h^2) / 2 = 2 r h u1.
    real constant =
        ring.half_width * (real(2.0) * radius * u1 - radius - real(0.5) * ring.elevation_sine * ring.half_width);
    real w = real(2.0) * constant /
             (radius + sqrt(max(radius * radius - real(2.0) * ring.elevation_sine * constant, real(0.0))));
    real rho = radius - w * ring.elevation_sine;
    // This frame is the specimen's turned half a turn about x: y and z change sign.
    real3 outward = real3(azimuth.cosine, -azimuth.sine, real(0.0));
    real3 around = real3(-azimuth.sine, -azimuth.cosine, real(0.0));
    real3 axis = real3(real(0.0), real(0.0), real(1.0));
    real3 normal = axis * ring.elevation_sine - outward * ring.elevation_cosine;
    real3 across = outward * (-ring.elevation_sine) - axis * ring.elevation_cosine;
    real3 direction = lambertian_direction(emission_sine, u2, u3);
    Ray ray;
    ray.position = outward * rho - axis * (ring.distance * ring.elevation_sine + w * ring.elevation_cosine);
    ray.direction = normal * direction.z + across * direction.x + around * direction.y;
    ray.path_length = real(0.0);
    return ray;
}
