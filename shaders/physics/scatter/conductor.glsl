// A polished metal: the law of reflection, and Fresnel's reflectance for unpolarised light of an absorbing medium
// (fresnel.glsl); the rest is absorbed. The index is that against vacuum, n + i k; the medium over the specimen is
// taken into account.
// parameter: refractive_index, 0.01, 20, 0.22, real part n of the index, here that of gold at 0.59 um
// parameter: extinction_coefficient, 0, 20, 3.05, imaginary part k of the index, here that of gold at 0.59 um
// delta
// lossy
// index

VKFV_FUNCTION ScatterTry conductor_try(real refractive_index, real extinction_coefficient, Incidence incidence, real,
                                       real, real u2) {
    real cosine = dot(incidence.mirror, incidence.normal);
    ScatterTry result;
    result.absorbed = false;
    result.direction = incidence.mirror;
    result.accepted = cosine > real(0.0) &&
                      u2 < absorbing_reflectance(refractive_index, extinction_coefficient, max(cosine, real(0.0)));
    return result;
}

VKFV_FUNCTION real conductor_bsdf(real, real, Incidence, real3) { return real(0.0); }
