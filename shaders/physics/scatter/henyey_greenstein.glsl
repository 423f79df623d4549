// Henyey-Greenstein scatter adapted to a surface. With alpha the angle between the outgoing direction and
// the mirror direction, the outgoing direction has the density
//   p(alpha; g) cos(theta_o) / N(theta_i, g)   over the hemisphere above the surface,
// p the function of L. G. Henyey and J. L. Greenstein, Astrophys. J. 93 (1941) 70, eq. 2, and N its integral. g = 0 is
// Lambertian, g = 1 the mirror, and no light is lost at any angle.
// Sharper backward lobes than g = -0.9 lie all but wholly below the surface: scatter() would run out of tries.
// parameter: g, -0.9, 1, 0, asymmetry: 0 is Lambertian and 1 the mirror
// table

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
    // The cosine law: cos^2(theta_o) uniform; 1 - sqrt(u) without its cancellation.
    real versine = cosine_law ? (real(1.0) - u0) / (real(1.0) + sqrt(u0)) : draw_henyey_greenstein_versine(g, u0);
    ScatterTry result;
    result.direction = direction_around(cosine_law ? incidence.normal : incidence.mirror, versine, u1);
    real least = real(1.0) - abs(g);
    real ratio = least * least / (real(1.0) + g * g - real(2.0) * g * dot(result.direction, incidence.mirror));
    real cosine = dot(result.direction, incidence.normal);
    real acceptance = cosine_law ? ratio * sqrt(ratio) : cosine;
    // The mirror (g = 1) has one direction, and trying it again would not change it.
    real threshold = g < real(1.0) ? u2 : real(0.0);
    result.accepted = cosine > real(0.0) && acceptance > threshold ? 1u : 0u;
    return result;
}

// N(theta_i, g) by the table, to 1e-6 of itself for g up to 0.999 and 2e-6 up to 0.9999, float's rounding included. As
// a function of the complex cosine N has branch points at +-i d, d = (1 - g^2) / (2 |g|), and no others; in x =
// sqrt(cosine^2 + d^2), N - g cosine / 2, which is even in the cosine, is smooth but on the negative axis, and a
// quotient of polynomials of degrees 6 and 5 follows it. For g < 0 that difference would cancel, and N itself is taken,
// in cosine + x.
struct HenyeyGreensteinPlace {
    real linear; // part of N left out of the quotient
    real x;
};
VKFV_FUNCTION HenyeyGreensteinPlace henyey_greenstein_place(real g, real distance_squared, real cosine) {
    real root = sqrt(cosine * cosine + distance_squared);
    HenyeyGreensteinPlace place;
    place.linear = g > real(0.0) ? real(0.5) * g * cosine : real(0.0);
    place.x = g > real(0.0) ? root : cosine + root;
    return place;
}

VKFV_FUNCTION real henyey_greenstein_norm(real g, real table[LOBE_TABLE_SIZE], real cosine) {
    HenyeyGreensteinPlace place = henyey_greenstein_place(g, table[12], cosine);
    real x = place.x;
    real above =
        table[0] + x * (table[1] + x * (table[2] + x * (table[3] + x * (table[4] + x * (table[5] + x * table[6])))));
    real below = real(1.0) + x * (table[7] + x * (table[8] + x * (table[9] + x * (table[10] + x * table[11]))));
    return place.linear + above / below;
}

VKFV_FUNCTION real henyey_greenstein_bsdf(real g, real table[LOBE_TABLE_SIZE], Incidence incidence, real3 outgoing) {
    real3 apart = outgoing - incidence.mirror;
    // 1 + g^2 - 2 g cos(alpha) without its cancellation.
    real base = (real(1.0) - g) * (real(1.0) - g) + g * dot(apart, apart);
    real bsdf = real(0.0);
    // At g = 1 it is a delta.
    if (g < real(1.0)) {
        real phase = real(0.0795774715459476679) * (real(1.0) - g) * (real(1.0) + g) / (base * sqrt(base));
        bsdf = phase / henyey_greenstein_norm(g, table, -dot(incidence.incoming, incidence.normal));
    }
    return bsdf;
}

#ifdef __cplusplus
// N(theta_i, g) to 1e-10 of itself. p is Poisson's kernel of the unit ball, so N is the harmonic function with the
// values max(cos(theta), 0) on the sphere, taken at g times the mirror direction. With z that point's height over the
// surface, N = max(z, 0) + I, where I is what the kernel of the point (|z|) gives the hemisphere away from it: small
// and smooth where the lobe is sharp. I is an integral over mu = |cos(theta_o)|, the one over the azimuth being
//   4 E(m) / ((a - b) sqrt(a + b)),  a + b = (s + rho)^2 + (mu + |z|)^2,  a - b = (s - rho)^2 + (mu + |z|)^2,
// s = sqrt(1 - mu^2), rho the point's distance from the normal, 1 - m = (a - b) / (a + b), E the complete elliptic
// integral. It changes over the point's distance from the horizon, hence mu = distance sinh(t), in panels of three
// Gauss points.
inline double henyey_greenstein_exact_norm(double g, double cosine) {
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0));
    const double magnitude = std::abs(g), height = magnitude * cosine, rho = magnitude * sine;
    const double inside = (1 - magnitude) + magnitude * cosine * cosine / (1 + sine); // 1 - rho
    const double scale = std::hypot(inside, height);
    constexpr int panels = 48;
    constexpr double places[] = {-0.774596669241483377, 0, 0.774596669241483377}, weights[] = {5, 8, 5};
    const double half_panel = 0.5 * std::asinh(1 / scale) / panels;
    double sum = 0;
    for (int point = 0; point < 3 * panels; ++point) {
        const double t = half_panel * (2 * (point / 3) + 1 + places[point % 3]);
        const double mu = scale * std::sinh(t), d_mu = scale * std::cosh(t); // over dt
        const double s = std::sqrt(std::max(1 - mu * mu, 0.0));
        const double across = inside - mu * mu / (1 + s); // s - rho
        const double rise = (mu + height) * (mu + height);
        const double least = across * across + rise, most = (s + rho) * (s + rho) + rise;
        const double modulus = std::sqrt(std::max(1 - least / most, 0.0));
        sum += weights[point % 3] / 9 * d_mu * mu * std::comp_ellint_2(modulus) / (least * std::sqrt(most));
    }
    return std::max(g * cosine, 0.0) + (1 - magnitude) * (1 + magnitude) / 3.14159265358979324 * half_panel * sum;
}

inline Lobe henyey_greenstein_tabulated(Lobe lobe) {
    const double g = lobe.parameter_0;
    if (g == 1) {
        return lobe;
    }
    // Farther branch points than 1 do not matter.
    const double distance = std::abs(g) > 0.4 ? (1 - g) * (1 + g) / (2 * std::abs(g)) : 1.0;
    // Chebyshev's points in the variable over which N changes evenly.
    constexpr int points = 100;
    std::vector<double> x, quotient;
    for (int k = 0; k < points; ++k) {
        const double place = 0.5 + 0.5 * std::cos(3.14159265358979324 * (k + 0.5) / points);
        const double cosine = std::min(distance * std::sinh(place * std::asinh(1 / distance)), 1.0);
        const auto at = henyey_greenstein_place(real(g), real(distance * distance), real(cosine));
        x.push_back(at.x);
        quotient.push_back(henyey_greenstein_exact_norm(g, cosine) - at.linear);
    }
    const RationalFit fit = fit_rational(x, quotient, 6, 5e-7);
    for (std::size_t k = 0; k < fit.numerator.size(); ++k) {
        lobe.table[k] = real(fit.numerator[k]);
    }
    for (std::size_t k = 1; k < fit.denominator.size(); ++k) {
        lobe.table[6 + k] = real(fit.denominator[k]);
    }
    lobe.table[12] = real(distance * distance);
    return lobe;
}
#endif
