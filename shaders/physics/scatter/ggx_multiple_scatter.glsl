// The facets of ggx with multiple scatter: light that ggx loses by reflecting each ray once is scattered between facets
// until it escapes. With E(i) the share that ggx keeps of light from i (Ggx tests; src/specimen/scatter_tables.cpp
// integrates it),
//   f = f_ggx + (1 - E(i)) (1 - E(o)) / (pi (1 - E_mean)),   E_mean = 2 times the integral of E cos over the cosine,
// the compensation of C. Kelemen and L. Szirmay-Kalos (Eurographics 2001, short presentations) as C. Kulla and A. Conty
// (SIGGRAPH 2017 course "Physically based shading") use it, for facets that reflect everything: it is reciprocal, and
// all light is kept at any incidence. Directions of light that was scattered more than once are those of this form, not
// those of a walk from facet to facet (E. Heitz et al., ACM Trans. Graph. 35 (2016) 58), which has no closed form.
// parameter: alpha, 0.001, 1, 0.3, roughness: half of the surface's projected area is steeper than this slope
// table
// drawn_by_table

// (1 - E) / sqrt(1 - E_mean) as a quotient of polynomials in a root of cosine / (cosine + 2 alpha), in which it is
// smooth except at the horizon, where E has a logarithm. E is reproduced to 1e-6.
VKFV_FUNCTION real ggx_multiple_scatter_lack(real alpha, real table[LOBE_TABLE_SIZE], real cosine) {
    real t = sqrt(cosine * (real(1.0) + real(2.0) * alpha) / (cosine + real(2.0) * alpha));
    if (alpha >= real(0.6)) {
        t = sqrt(t);
    }
    real z = real(2.0) * t - real(1.0);
    real above = table[4] + z * (table[5] + z * (table[6] + z * table[7]));
    above = table[0] + z * (table[1] + z * (table[2] + z * (table[3] + z * above)));
    real below = table[11] + z * (table[12] + z * (table[13] + z * table[14]));
    below = real(1.0) + z * (table[8] + z * (table[9] + z * (table[10] + z * below)));
    return max(t * above / below, real(0.0));
}

// True if light that is scattered more than once is proposed uniformly, false if by the cosine law. Its density lack *
// cosine is flatter for smooth surfaces than the cosine itself and about as steep for rough ones.
VKFV_FUNCTION bool ggx_multiple_scatter_is_smooth(real alpha) { return alpha < real(0.35); }

// A share of all tries proposes a direction of ggx, the others one of light that is scattered more than once. With lack
// <= bound (2 lack cosine <= bound for smooth surfaces, whose proposals are even over the hemisphere) such proposals
// are accepted with the probability 1 / bound sqrt(1 - E_mean); the share balances the accepted ones to their
// densities.
VKFV_FUNCTION ScatterTry ggx_multiple_scatter_try(real alpha, real table[LOBE_TABLE_SIZE], Incidence incidence, real u0,
                                                  real u1, real u2) {
    bool smooth_surface = ggx_multiple_scatter_is_smooth(alpha);
    real bound = table[15];
    real incoming_cosine = -dot(incidence.incoming, incidence.normal);
    real once =
        real(1.0) / (real(1.0) + bound * ggx_multiple_scatter_lack(alpha, table, max(incoming_cosine, real(0.0))));
    ScatterTry result;
    if (u2 < once) {
        result = ggx_try(alpha, incidence, u0, u1, u2 / once);
    } else {
        real versine = smooth_surface ? u0 : (real(1.0) - u0) / (real(1.0) + sqrt(u0));
        result.direction = direction_around(incidence.normal, versine, u1);
        result.absorbed = false;
        real cosine = dot(result.direction, incidence.normal);
        real lack = ggx_multiple_scatter_lack(alpha, table, max(cosine, real(0.0)));
        real rest = (u2 - once) / (real(1.0) - once);
        result.accepted = cosine > real(0.0) && rest * bound < (smooth_surface ? real(2.0) * cosine * lack : lack);
    }
    return result;
}

VKFV_FUNCTION real ggx_multiple_scatter_bsdf(real alpha, real table[LOBE_TABLE_SIZE], Incidence incidence,
                                             real3 outgoing) {
    real incoming_cosine = max(-dot(incidence.incoming, incidence.normal), real(0.0));
    real cosine = max(dot(outgoing, incidence.normal), real(0.0));
    return ggx_bsdf(alpha, incidence, outgoing) + real(0.318309886183790672) *
                                                      ggx_multiple_scatter_lack(alpha, table, incoming_cosine) *
                                                      ggx_multiple_scatter_lack(alpha, table, cosine);
}
