// Henyey-Greenstein scatter adapted to a surface (DESIGN.md 4). With alpha the angle between the outgoing direction and
// the mirror direction, the outgoing direction has the density
//   p(alpha; g) cos(theta_o) / N(theta_i, g)   over the hemisphere above the surface,
// p the function of L. G. Henyey and J. L. Greenstein, Astrophys. J. 93 (1941) 70, eq. 2, and N its integral. g = 0 is
// Lambertian, g = 1 the mirror, and no light is lost at any angle.
// Sharper backward lobes than g = -0.9 lie all but wholly below the surface: scatter() would run out of tries.
// parameter: g, -0.9, 1, 0, asymmetry: 0 is Lambertian and 1 the mirror

// 1 - cos(alpha) of a Henyey-Greenstein draw. The usual inversion, rearranged so that neither g -> 0 nor alpha -> 0
// cancels: 2 (1 - g)^2 (1 - u) (1 + g u) / (1 - g + 2 g u)^2, with cos(alpha) ascending in u.
VKFV_FUNCTION real draw_henyey_greenstein_versine(real g, real u) {
    real denominator = real(1.0) - g + real(2.0) * g * u;
    real ratio = (real(1.0) - g) / denominator;
    return real(2.0) * ratio * ratio * (real(1.0) - u) * (real(1.0) + g * u);
}

// Rejection needs 1 / acceptance tries on average. Two proposals have the wanted density after it:
//   lobe:   draw alpha from p, accept with cos(theta_o):                  acceptance N
//   cosine: draw theta_o from the cosine law, accept with p(alpha) / p(0): acceptance 4 N (1 - g)^2 / (1 + g)
// (for g < 0, p is largest at 180 degrees and |g| takes g's place). The better one is taken, so that g = 0 needs one
// try, and no g > 0 more than about 2.5 at normal incidence; g < 0 needs more, 50 at -0.8, as its lobe lies below.
VKFV_FUNCTION uint henyey_greenstein_proposes_cosine(real g) {
    real magnitude = abs(g);
    real one_minus = real(1.0) - magnitude;
    return real(4.0) * one_minus * one_minus > real(1.0) + magnitude ? 1u : 0u;
}

VKFV_FUNCTION ScatterTry henyey_greenstein_try(real g, Incidence incidence, real u0, real u1, real u2) {
    bool cosine_law = henyey_greenstein_proposes_cosine(g) == 1u;
    // The cosine law: cos^2(theta_o) uniform.
    real versine = cosine_law ? real(1.0) - sqrt(u0) : draw_henyey_greenstein_versine(g, u0);
    ScatterTry result;
    result.direction = direction_around(cosine_law ? incidence.normal : incidence.mirror, versine,
                                        real(6.283185307179586477) * u1);
    real least = real(1.0) - abs(g);
    real ratio = least * least / (real(1.0) + g * g - real(2.0) * g * dot(result.direction, incidence.mirror));
    real cosine = dot(result.direction, incidence.normal);
    real acceptance = cosine_law ? ratio * sqrt(ratio) : cosine;
    // The mirror (g = 1) has one direction, and trying it again would not change it.
    real threshold = g < real(1.0) ? u2 : real(0.0);
    result.accepted = cosine > real(0.0) && acceptance > threshold ? 1u : 0u;
    return result;
}

// Complete elliptic integral of the second kind E(m) by its complement 1 - m, to 2e-8: C. Hastings, Approximations for
// Digital Computers (1955), in M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, 17.3.36.
VKFV_FUNCTION real elliptic_e(real complement) {
    real x = complement;
    real plain = x * (real(0.44325141463) + x * (real(0.06260601220) + x * (real(0.04757383546) + x * real(0.01736506451))));
    real with_log = x * (real(0.24998368310) + x * (real(0.09200180037) + x * (real(0.04069697526) + x * real(0.00526449639))));
    return real(1.0) + plain - with_log * log(x);
}

// N(theta_i, g), to 1e-5 of itself. p is Poisson's kernel of the unit ball, so N is the harmonic function with the
// values max(cos(theta), 0) on the sphere, taken at g times the mirror direction. With z that point's height over the
// surface, N = max(z, 0) + I, where I is what the kernel of the point (|z|) gives the hemisphere away from it: small
// and smooth where the lobe is sharp. I is an integral over mu = |cos(theta_o)|, the one over the azimuth being
//   4 E(m) / ((a - b) sqrt(a + b)),  a + b = (s + rho)^2 + (mu + |z|)^2,  a - b = (s - rho)^2 + (mu + |z|)^2,
// s = sqrt(1 - mu^2), rho the point's distance from the normal, 1 - m = (a - b) / (a + b). It changes over the
// point's distance d from the horizon, hence mu = d sinh(t), in panels of three Gauss points.
VKFV_FUNCTION real henyey_greenstein_norm(real g, real cosine) {
    real sine = sqrt(max(real(1.0) - cosine * cosine, real(0.0)));
    real magnitude = abs(g);
    real height = magnitude * cosine;
    real rho = magnitude * sine;
    real inside = (real(1.0) - magnitude) + magnitude * cosine * cosine / (real(1.0) + sine); // 1 - rho
    real scale = sqrt(inside * inside + height * height);
    real last = log(real(1.0) / scale + sqrt(real(1.0) / (scale * scale) + real(1.0)));
    const int panels = 8;
    real half_panel = real(0.5) * last / real(panels);
    real sum = real(0.0);
    for (int point = 0; point < 3 * panels; ++point) {
        int place = point % 3 - 1; // of the Gauss point in its panel
        real t = half_panel * (real(2 * (point / 3) + 1) + real(place) * real(0.774596669241483377));
        real e = exp(t);
        real mu = real(0.5) * scale * (e - real(1.0) / e);
        real d_mu = real(0.5) * scale * (e + real(1.0) / e); // over dt
        real s = sqrt(max(real(1.0) - mu * mu, real(0.0)));
        real across = inside - mu * mu / (real(1.0) + s); // s - rho
        real rise = (mu + height) * (mu + height);
        real least = across * across + rise;
        real most = (s + rho) * (s + rho) + rise;
        real weight = place == 0 ? real(0.888888888888888889) : real(0.555555555555555556);
        sum = sum + weight * d_mu * mu * elliptic_e(least / most) / (least * sqrt(most));
    }
    real integral = real(0.318309886183790672) * (real(1.0) - magnitude) * (real(1.0) + magnitude) * half_panel * sum;
    return max(g * cosine, real(0.0)) + integral;
}

VKFV_FUNCTION real henyey_greenstein_density(real g, Incidence incidence, real3 outgoing) {
    real cosine = dot(outgoing, incidence.normal);
    real3 apart = outgoing - incidence.mirror;
    // 1 + g^2 - 2 g cos(alpha) without its cancellation.
    real base = (real(1.0) - g) * (real(1.0) - g) + g * dot(apart, apart);
    real density = real(0.0);
    // At g = 1 it is a delta.
    if (cosine > real(0.0) && g < real(1.0)) {
        real phase = real(0.0795774715459476679) * (real(1.0) - g) * (real(1.0) + g) / (base * sqrt(base));
        density = phase * cosine / henyey_greenstein_norm(g, -dot(incidence.incoming, incidence.normal));
    }
    return density;
}
