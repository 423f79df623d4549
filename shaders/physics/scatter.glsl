// Henyey-Greenstein scatter adapted to a surface (DESIGN.md 4). With alpha the angle between the outgoing direction and
// the mirror direction, the outgoing direction has the density
//   p(alpha; g) cos(theta_o) / N(theta_i, g)   over the hemisphere above the surface,
// p the function of L. G. Henyey and J. L. Greenstein, Astrophys. J. 93 (1941) 70, eq. 2, and N its integral. g = 0 is
// Lambertian, g = 1 the mirror, and no light is lost at any angle.

// Per sr.
VKFV_FUNCTION real henyey_greenstein(real cosine, real g) {
    real base = real(1.0) + g * g - real(2.0) * g * cosine;
    return real(0.0795774715459476679) * (real(1.0) - g * g) / (base * sqrt(base));
}

// 1 - cos(alpha) of a Henyey-Greenstein draw. The usual inversion, rearranged so that neither g -> 0 nor alpha -> 0
// cancels: 2 (1 - g)^2 (1 - u) (1 + g u) / (1 - g + 2 g u)^2, with cos(alpha) ascending in u.
VKFV_FUNCTION real draw_henyey_greenstein_versine(real g, real u) {
    real denominator = real(1.0) - g + real(2.0) * g * u;
    real ratio = (real(1.0) - g) / denominator;
    return real(2.0) * ratio * ratio * (real(1.0) - u) * (real(1.0) + g * u);
}

struct Frame {
    real3 first;
    real3 second;
};

// Two unit vectors at right angles to the unit vector w: T. Duff et al., "Building an orthonormal basis, revisited",
// JCGT 6 (2017) 1.
VKFV_FUNCTION Frame frame_around(real3 w) {
    real sign_z = w.z >= real(0.0) ? real(1.0) : real(-1.0);
    real a = real(-1.0) / (sign_z + w.z);
    real b = w.x * w.y * a;
    Frame frame;
    frame.first = real3(real(1.0) + sign_z * w.x * w.x * a, sign_z * b, -sign_z * w.x);
    frame.second = real3(b, sign_z + w.y * w.y * a, -w.y);
    return frame;
}

// Unit vector at the angle of the given versine (1 - cos) from the unit vector axis, at the azimuth phi.
VKFV_FUNCTION real3 direction_around(real3 axis, real versine, real phi) {
    Frame frame = frame_around(axis);
    real sine = sqrt(max(versine * (real(2.0) - versine), real(0.0)));
    return axis * (real(1.0) - versine) + frame.first * (sine * cos(phi)) + frame.second * (sine * sin(phi));
}

// Rejection needs 1 / acceptance tries on average. Two proposals have the wanted density after it:
//   lobe:   draw alpha from p, accept with cos(theta_o):                  acceptance N
//   cosine: draw theta_o from the cosine law, accept with p(alpha) / p(0): acceptance 4 N (1 - g)^2 / (1 + g)
// (for g < 0, p is largest at 180 degrees and |g| takes g's place). The better one is taken, so that g = 0 needs one
// try, and no g > 0 more than about 2.5 at normal incidence; g < 0 needs more, 50 at -0.8, as its lobe lies below.
VKFV_FUNCTION uint scatter_proposes_cosine(real g) {
    real magnitude = abs(g);
    real one_minus = real(1.0) - magnitude;
    return real(4.0) * one_minus * one_minus > real(1.0) + magnitude ? 1u : 0u;
}

struct ScatterTry {
    uint accepted;
    real3 direction; // unit
};

// normal: unit, on the side the light comes from; mirror: unit mirror direction.
VKFV_FUNCTION ScatterTry try_scatter(real g, real3 normal, real3 mirror, real u0, real u1, real u2) {
    bool cosine_law = scatter_proposes_cosine(g) == 1u;
    // The cosine law: cos^2(theta_o) uniform.
    real versine = cosine_law ? real(1.0) - sqrt(u0) : draw_henyey_greenstein_versine(g, u0);
    ScatterTry result;
    result.direction = direction_around(cosine_law ? normal : mirror, versine, real(6.283185307179586477) * u1);
    real least = real(1.0) - abs(g);
    real ratio = least * least / (real(1.0) + g * g - real(2.0) * g * dot(result.direction, mirror));
    real cosine = dot(result.direction, normal);
    real acceptance = cosine_law ? ratio * sqrt(ratio) : cosine;
    // The mirror (g = 1) has one direction, and trying it again would not change it.
    real threshold = g < real(1.0) ? u2 : real(0.0);
    result.accepted = cosine > real(0.0) && acceptance > threshold ? 1u : 0u;
    return result;
}

// The acceptance is no less than about cos(theta_i) for sharp lobes with g > 0, and about 0.01 for g = -0.9, the least that a
// configuration may ask for: 2048 tries fail less than once in 1e8 for incidence up to 89.4 degrees. What fails is counted
// as numerical.
const uint SCATTER_BLOCKS = 2048u; // blocks of random numbers a scatter event owns; one try each

struct Scattered {
    uint accepted; // 0: tries exhausted
    real3 direction;
};

// incoming: unit, towards the surface; normal: unit, on the incoming side.
VKFV_FUNCTION Scattered scatter(real g, real3 incoming, real3 normal, uint seed, uint image, uvec2 path,
                                uint first_block) {
    real3 mirror = incoming - normal * (real(2.0) * dot(incoming, normal));
    Scattered result;
    result.accepted = 0u;
    result.direction = mirror;
    // Light from behind the surface is a rounding fault (it slipped between facets): not scattered, but counted.
    uint blocks = dot(incoming, normal) < real(0.0) ? SCATTER_BLOCKS : 0u;
    for (uint block = 0u; block < blocks && result.accepted == 0u; ++block) {
        Draws draws = draw(seed, image, path, first_block + block);
        ScatterTry attempt = try_scatter(g, normal, mirror, draws.u0, draws.u1, draws.u2);
        result.accepted = attempt.accepted;
        result.direction = attempt.direction;
    }
    return result;
}
