// Mirroring facets by the distribution of S. Trowbridge and K. P. Reitz, J. Opt. Soc. Am. 65 (1975) 531, called GGX by
// B. Walter et al., EGSR 2007, with the height-correlated masking of E. Heitz, JCGT 3 (2014) 48, eq. 99, for facets
// that reflect everything, each ray once. With m the facets' normal, halfway between both directions,
//   f = D(m) / (4 cos_i cos_o (1 + L_i + L_o)),   L = (sqrt(1 + alpha^2 tan^2(theta)) - 1) / 2,
//   D = alpha^2 / (pi cos^4(theta_m) (alpha^2 + tan^2(theta_m))^2).
// The model is reciprocal: f(i, o) = f(o, i). Light that other facets would catch is absorbed, as it is scattered only
// once. At normal incidence this is 1 % with alpha = 0.1, 12 % with 0.3, 31 % with 0.5 and 69 % with 1;
// ggx_multiple_scatter.glsl keeps it.
// parameter: alpha, 0.001, 1, 0.3, roughness: half of the surface's projected area is steeper than this slope
// lossy

// sqrt(1 + alpha^2 tan^2) times the cosine: 1 + L_i + L_o = (reach_i / cos_i + reach_o / cos_o) / 2.
VKFV_FUNCTION real ggx_reach(real alpha, real cosine) {
    return sqrt(alpha * alpha + (real(1.0) - alpha) * (real(1.0) + alpha) * cosine * cosine);
}

// Facets are drawn as the incoming light sees them, by spherical caps: J. Dupuy and A. Benyoub, Computer Graphics Forum
// 42 (2023) 8. The share G_2 / G_1 of the light that they mirror escapes.
VKFV_FUNCTION ScatterTry ggx_try(real alpha, Incidence incidence, real u0, real u1, real u2) {
    real3 normal = incidence.normal;
    real incoming_cosine = -dot(incidence.incoming, normal);
    // In stretched space the facets are those of a hemisphere, and their normals lie halfway to the directions of a
    // cap, which is uniform.
    real3 flat_part = (incidence.incoming + normal * incoming_cosine) * -alpha;
    real scale = real(1.0) / sqrt(dot(flat_part, flat_part) + incoming_cosine * incoming_cosine);
    flat_part = flat_part * scale;
    real cap = real(1.0) + incoming_cosine * scale;
    real left = (real(1.0) - u0) * cap;
    // The versine is u0 * cap; left is the component along the normal of the sum of both directions.
    real sine = sqrt(u0 * cap * (left + dot(flat_part, flat_part) / cap));
    Frame frame = frame_around(normal);
    Turn turn = turn_of(u1);
    real3 facet = flat_part + frame.first * (sine * turn.cosine) + frame.second * (sine * turn.sine);
    facet = facet * alpha + normal * left;
    facet = facet * (real(1.0) / sqrt(dot(facet, facet)));
    ScatterTry result;
    result.absorbed = false;
    result.direction = mirrored(incidence.incoming, facet);
    real cosine = dot(result.direction, normal);
    real incoming_reach = ggx_reach(alpha, incoming_cosine);
    real seen = cosine * (incoming_cosine + incoming_reach);
    real shadowed = incoming_reach * cosine + incoming_cosine * ggx_reach(alpha, cosine);
    result.accepted = cosine > real(0.0) && seen > u2 * shadowed;
    return result;
}

VKFV_FUNCTION real ggx_bsdf(real alpha, Incidence incidence, real3 outgoing) {
    real incoming_cosine = -dot(incidence.incoming, incidence.normal);
    real cosine = max(dot(outgoing, incidence.normal), real(0.0));
    // The facet's normal, of any length; tan^2 = across / up^2 avoids the cancellation of 1 - cos^2.
    real3 half_way = outgoing - incidence.incoming;
    real up = dot(half_way, incidence.normal);
    real3 flat_part = half_way - incidence.normal * up;
    real across = dot(flat_part, flat_part);
    real spread = alpha * alpha * up * up + across;
    real ratio = alpha * (up * up + across) / spread;
    real shadowed = ggx_reach(alpha, incoming_cosine) * cosine + incoming_cosine * ggx_reach(alpha, cosine);
    return real(0.159154943091895336) * ratio * ratio / shadowed;
}
