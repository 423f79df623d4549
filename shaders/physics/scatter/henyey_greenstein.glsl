// Henyey-Greenstein scatter adapted to a surface. With alpha the angle between the outgoing direction and
// the mirror direction, the outgoing direction has the density
//   p(alpha; g) cos(theta_o) / N(theta_i, g)   over the hemisphere above the surface,
// where p is the function of L. G. Henyey and J. L. Greenstein, Astrophys. J. 93 (1941) 70, eq. 2, and N its integral.
// g = 0 is Lambertian, g = 1 the mirror, and no light is lost at any angle. Hence it is not reciprocal: p is symmetric
// in both directions, but N belongs to the incidence alone. At g = 0.8, light from 60 degrees into the normal is 1.87
// times as bright as light from the normal into 60 degrees; ggx is reciprocal.
// Sharper backward lobes than g = -0.9 lie all but wholly below the surface: scatter() would run out of tries.
// parameter: g, -0.9, 1, 0, asymmetry: 0 is Lambertian and 1 the mirror
// table
// ceiling
// cone

// 1 - cos(alpha) of a Henyey-Greenstein draw: the usual inversion, rearranged so that neither g -> 0 nor alpha -> 0
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
VKFV_FUNCTION bool henyey_greenstein_proposes_cosine(real g) {
    real magnitude = abs(g);
    real one_minus = real(1.0) - magnitude;
    return real(4.0) * one_minus * one_minus > real(1.0) + magnitude;
}

VKFV_FUNCTION ScatterTry henyey_greenstein_try(real g, Incidence incidence, real u0, real u1, real u2) {
    bool cosine_law = henyey_greenstein_proposes_cosine(g);
    // By the cosine law cos^2(theta_o) is uniform; 1 - sqrt(u) is formed without cancellation.
    real versine = cosine_law ? (real(1.0) - u0) / (real(1.0) + sqrt(u0)) : draw_henyey_greenstein_versine(g, u0);
    ScatterTry result;
    result.absorbed = false;
    result.direction = direction_around(cosine_law ? incidence.normal : incidence.mirror, versine, u1);
    real least = real(1.0) - abs(g);
    real ratio = least * least / (real(1.0) + g * g - real(2.0) * g * dot(result.direction, incidence.mirror));
    real cosine = dot(result.direction, incidence.normal);
    real acceptance = cosine_law ? ratio * sqrt(ratio) : cosine;
    // The mirror (g = 1) has one direction, and trying it again would not change it.
    real threshold = g < real(1.0) ? u2 : real(0.0);
    result.accepted = cosine > real(0.0) && acceptance > threshold;
    return result;
}

// N(theta_i, g) by the table, to 1e-6 of its value for g up to 0.999 and 2e-6 up to 0.9999, float's rounding included.
// As a function of the complex cosine N has branch points at +-i d, d = (1 - g^2) / (2 |g|), and no others; in x =
// sqrt(cosine^2 + d^2), N - g cosine / 2, which is even in the cosine, is smooth but on the negative axis, and a
// quotient of polynomials of degrees 6 and 5 follows it. For g < 0 that difference would cancel, so N itself is
// approximated, in cosine + x.
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

// p / N at 1 + g^2 - 2 g cos(alpha) = base.
VKFV_FUNCTION real henyey_greenstein_of_base(real g, real table[LOBE_TABLE_SIZE], Incidence incidence, real base) {
    real phase = real(0.0795774715459476679) * (real(1.0) - g) * (real(1.0) + g) / (base * sqrt(base));
    return phase / henyey_greenstein_norm(g, table, -dot(incidence.incoming, incidence.normal));
}

VKFV_FUNCTION real henyey_greenstein_bsdf(real g, real table[LOBE_TABLE_SIZE], Incidence incidence, real3 outgoing) {
    real3 apart = outgoing - incidence.mirror;
    // 1 + g^2 - 2 g cos(alpha) is formed without cancellation.
    real base = (real(1.0) - g) * (real(1.0) - g) + g * dot(apart, apart);
    // The lobe is a delta at g = 1.
    return g < real(1.0) ? henyey_greenstein_of_base(g, table, incidence, base) : real(0.0);
}

// An upper bound of the BSDF. For g < 0 the base is least at 180 degrees.
VKFV_FUNCTION real henyey_greenstein_ceiling(real g, real table[LOBE_TABLE_SIZE], Incidence incidence, real apart) {
    real least = real(1.0) - abs(g);
    real base = least * least + max(g, real(0.0)) * apart * apart;
    return g < real(1.0) ? henyey_greenstein_of_base(g, table, incidence, base) : real(0.0);
}

// Draws a direction from p within the cone, which holds 1 - outside of its mass: the ratio is cos(theta_o) (1 -
// outside) / N.
VKFV_FUNCTION ConeDraw henyey_greenstein_cone(real g, real table[LOBE_TABLE_SIZE], Incidence incidence, real versine,
                                              real u0, real u1) {
    ConeDraw result;
    result.bound = real(0.0);
    result.ratio = real(0.0);
    result.direction = incidence.mirror;
    if (g > real(0.0) && g < real(1.0)) {
        // outside = (1 - g) ((1 + g) / root - 1) / (2 g), formed without cancellation for a small g.
        real root = sqrt((real(1.0) - g) * (real(1.0) - g) + real(2.0) * g * versine);
        real outside = (real(1.0) - g) * (real(2.0) - versine) / (root * (real(1.0) + g + root));
        real inside = real(1.0) - outside;
        result.bound = inside / henyey_greenstein_norm(g, table, -dot(incidence.incoming, incidence.normal));
        real drawn = draw_henyey_greenstein_versine(g, outside + inside * u0);
        result.direction = direction_around(incidence.mirror, drawn, u1);
        result.ratio = result.bound * dot(result.direction, incidence.normal);
    }
    return result;
}
