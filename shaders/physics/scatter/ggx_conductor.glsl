// The facets of ggx, of a metal: each reflects by Fresnel's equations for unpolarised light of an absorbing medium
// (fresnel.glsl), at its angle of incidence. The model is reciprocal. Light that other facets would catch is absorbed,
// as it is by ggx.
// parameter: refractive_index, 0.01, 20, 0.22, real part n of the index, here that of gold at 0.59 um
// parameter: extinction_coefficient, 0, 20, 3.05, imaginary part k of the index, here that of gold at 0.59 um
// parameter: alpha, 0.001, 1, 0.3, roughness: half of the surface's projected area is steeper than this slope
// lossy
// index

// The reflectance of the facet that mirrors the light into this direction.
VKFV_FUNCTION real ggx_conductor_reflectance(real refractive_index, real extinction_coefficient, Incidence incidence,
                                             real3 outgoing) {
    real3 half_way = outgoing - incidence.incoming;
    real cosine = real(0.5) * sqrt(dot(half_way, half_way));
    return absorbing_reflectance(refractive_index, extinction_coefficient, min(cosine, real(1.0)));
}

VKFV_FUNCTION ScatterTry ggx_conductor_try(real refractive_index, real extinction_coefficient, real alpha,
                                           Incidence incidence, real u0, real u1, real u2) {
    ScatterTry facet = ggx_try(alpha, incidence, u0, u1, real(0.0)); // the direction does not depend on u2
    real reflectance = ggx_conductor_reflectance(refractive_index, extinction_coefficient, incidence, facet.direction);
    return ggx_try(alpha, incidence, u0, u1, u2 / max(reflectance, real(1e-30)));
}

VKFV_FUNCTION real ggx_conductor_bsdf(real refractive_index, real extinction_coefficient, real alpha,
                                      Incidence incidence, real3 outgoing) {
    return ggx_bsdf(alpha, incidence, outgoing) *
           ggx_conductor_reflectance(refractive_index, extinction_coefficient, incidence, outgoing);
}
