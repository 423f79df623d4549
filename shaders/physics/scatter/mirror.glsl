// The law of reflection: one direction for each incidence.
// delta

VKFV_FUNCTION ScatterTry mirror_try(Incidence incidence, real, real, real) {
    ScatterTry result;
    result.absorbed = false;
    result.direction = incidence.mirror;
    result.accepted = dot(incidence.mirror, incidence.normal) > real(0.0);
    return result;
}

VKFV_FUNCTION real mirror_bsdf(Incidence, real3) { return real(0.0); }
