// Light sources, all Lambertian: uniform radiance, so position is uniform over the area and the direction has the density
// cos(theta) / (pi sin^2(theta_max)) within the cone sin(theta) <= emission_sine about the normal: the unit disc of
// (l, m), scaled. With emission_sine = 1 this is the whole hemisphere; less aims at a cone, which holds the share
// emission_sine^2 of the flux, exactly and from every point. Directions are unit vectors.

// cos and sin of 2 pi u for u in [0, 1], asked for in [-pi, pi] alone: beyond, Vulkan bounds no error.
struct Turn {
    real cosine;
    real sine;
};
VKFV_FUNCTION Turn turn_of(real u) {
    real angle = real(6.283185307179586477) * (u - (u > real(0.5) ? real(1.0) : real(0.0)));
    Turn turn;
    turn.cosine = cos(angle);
    turn.sine = sin(angle);
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

// A ring light about the z axis that shines on the origin from z < 0. Its band lies on a cone: at w across the band, from
// the ring's inside, its radius is r - w sin(elevation), and so is its share of the area.
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
    real constant = ring.half_width * (real(2.0) * radius * u1 - radius -
                                       real(0.5) * ring.elevation_sine * ring.half_width);
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
