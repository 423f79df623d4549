// Lambert's cosine law, J. H. Lambert, Photometria (1760): the same radiance in every direction, cos(theta_o) / pi.
// ceiling

// By the cosine law cos^2(theta_o) is uniform; 1 - sqrt(u) is formed without cancellation.
VKFV_FUNCTION ScatterTry lambertian_try(Incidence incidence, real u0, real u1, real) {
    ScatterTry result;
    result.absorbed = false;
    result.direction = direction_around(incidence.normal, (real(1.0) - u0) / (real(1.0) + sqrt(u0)), u1);
    result.accepted = dot(result.direction, incidence.normal) > real(0.0);
    return result;
}

VKFV_FUNCTION real lambertian_bsdf(Incidence, real3) { return real(0.318309886183790672); }

VKFV_FUNCTION real lambertian_ceiling(Incidence, real) { return real(0.318309886183790672); }
