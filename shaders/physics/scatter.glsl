// Scatter at the specimen: its material is a weighted sum of lobes, each of one model of scatter/.
//
// Densities are not symmetric, and some models' bsdf is not reciprocal: theta_i is always the angle on the source's
// side, also for a path that is traced backward, so a backward path gives scatter_density() its own direction reversed
// as `outgoing`.

// Chooses a lobe by one number, uniform in (0, 1), with the probability of its weight, or SCATTER_NONE. Unused lobes
// have the weight 0.
VKFV_FUNCTION Lobe choose_lobe(Material material, real u) {
    Lobe lobe = material.lobe_0;
    real bound = lobe.weight;
    if (u >= bound) {
        lobe = material.lobe_1;
        bound = bound + lobe.weight;
    }
    if (u >= bound) {
        lobe = material.lobe_2;
        bound = bound + lobe.weight;
    }
    if (u >= bound) {
        lobe = material.lobe_3;
        bound = bound + lobe.weight;
    }
    if (u >= bound) {
        lobe.model = SCATTER_NONE;
    }
    return lobe;
}

VKFV_SCENE_FUNCTION VKFV_FUNCTION real weighted_bsdf(VKFV_SCENE_PARAMETER Lobe lobe, Incidence incidence,
                                                     real3 outgoing) {
    return lobe.weight > real(0.0) ? lobe.weight * lobe_bsdf(VKFV_SCENE lobe, incidence, outgoing) : real(0.0);
}

// The material's BSDF: share of the incident light per sr of the unit direction outgoing, divided by the cosine of its
// angle with the normal, 1/sr. It is finite at grazing angles, and 0 unless both directions are above the surface.
// Deltas, which have no density, count as 0. incoming: unit, towards the surface; normal: unit, on the incoming side.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real scatter_bsdf(VKFV_SCENE_PARAMETER Material material, real3 incoming,
                                                    real3 normal, real3 outgoing) {
    Incidence incidence = make_incidence(incoming, normal);
    real bsdf = weighted_bsdf(VKFV_SCENE material.lobe_0, incidence, outgoing);
    if ((scatter_models & SCATTER_CHOICE) != 0u) {
        bsdf = bsdf + weighted_bsdf(VKFV_SCENE material.lobe_1, incidence, outgoing) +
               weighted_bsdf(VKFV_SCENE material.lobe_2, incidence, outgoing) +
               weighted_bsdf(VKFV_SCENE material.lobe_3, incidence, outgoing);
    }
    return dot(incoming, normal) < real(0.0) && dot(outgoing, normal) > real(0.0) ? bsdf : real(0.0);
}

// The BSDF times the cosine, per sr of the outgoing direction: its integral over the hemisphere is the reflectance,
// less the share that lossy lobes absorb.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real scatter_density(VKFV_SCENE_PARAMETER Material material, real3 incoming,
                                                       real3 normal, real3 outgoing) {
    return scatter_bsdf(VKFV_SCENE material, incoming, normal, outgoing) * max(dot(outgoing, normal), real(0.0));
}

// Blocks of random numbers that a scatter event owns: two tries each; the last block is directed scatter's.
// Henyey-Greenstein's acceptance is no less than about cos(theta_i) for sharp lobes with g > 0, and about 0.01 for g =
// -0.9, the least that a configuration may ask for: 2048 tries, half of the available ones, fail less than once in 1e8
// for incidence up to 89.4 degrees. Failed events are counted as numerical.
const uint SCATTER_BLOCKS = 2048u;

struct Scattered {
    bool accepted; // false: absorbed, or tries exhausted
    bool absorbed;
    real3 direction;
    Lobe lobe; // the chosen lobe; if none was chosen, its model is SCATTER_NONE
};

// The lobe that the first block of a scatter event chooses.
VKFV_FUNCTION Lobe scattering_lobe(Material material, Draws draws) {
    Lobe lobe = material.lobe_0;
    if ((scatter_models & SCATTER_CHOICE) != 0u) {
        lobe = choose_lobe(material, draws.u5);
    }
    return lobe;
}

// Scatter by rejection. most_blocks: of random numbers, two tries each, but one where the first block's numbers also
// choose a lobe.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Scattered scatter_by_tries(VKFV_SCENE_PARAMETER Material material,
                                                             Incidence incidence, uint seed, uint image, uvec2 path,
                                                             uint first_block, uint most_blocks) {
    Lobe lobe = material.lobe_0;
    Scattered result;
    result.accepted = false;
    result.absorbed = false;
    result.direction = incidence.mirror;
    // Light from behind the surface is a rounding fault (it slipped between facets): it is not scattered, but counted.
    uint blocks = dot(incidence.incoming, incidence.normal) < real(0.0) ? most_blocks : 0u;
    for (uint block = 0u; block < blocks && !result.accepted && !result.absorbed; ++block) {
        Draws draws = draw(seed, image, path, first_block + block);
        // The test is of the material, so that host and device take the same branch.
        bool chooses = (scatter_models & SCATTER_CHOICE) != 0u && block == 0u && material.lobe_0.weight < real(1.0);
        if (chooses) {
            lobe = scattering_lobe(material, draws);
            result.absorbed = lobe.model == SCATTER_NONE;
        }
        ScatterTry attempt = lobe_try(VKFV_SCENE lobe, incidence, draws.u0, draws.u1, draws.u2);
        result.absorbed = result.absorbed || attempt.absorbed || (!attempt.accepted && lobe_is_lossy(lobe));
        if (!attempt.accepted && !result.absorbed && !chooses) {
            attempt = lobe_try(VKFV_SCENE lobe, incidence, draws.u3, draws.u4, draws.u5);
            result.absorbed = attempt.absorbed;
        }
        result.accepted = attempt.accepted;
        result.direction = attempt.direction;
        VKFV_LEAVE_IF(result.accepted || result.absorbed);
    }
    result.lobe = lobe;
    return result;
}

// Scatter at a point of the specimen. incoming: unit, towards the surface; normal: unit, on the incoming side.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Scattered scatter(VKFV_SCENE_PARAMETER Material material, real3 incoming,
                                                    real3 normal, uint seed, uint image, uvec2 path, uint first_block) {
    return scatter_by_tries(VKFV_SCENE material, make_incidence(incoming, normal), seed, image, path, first_block,
                            SCATTER_BLOCKS - 1u);
}

#ifdef __cplusplus
inline real scatter_bsdf(Material material, real3 incoming, real3 normal, real3 outgoing) {
    return scatter_bsdf(NoNumbers{}, material, incoming, normal, outgoing);
}
inline real scatter_density(Material material, real3 incoming, real3 normal, real3 outgoing) {
    return scatter_density(NoNumbers{}, material, incoming, normal, outgoing);
}
inline Scattered scatter(Material material, real3 incoming, real3 normal, uint seed, uint image, uvec2 path,
                         uint first_block) {
    return scatter(NoNumbers{}, material, incoming, normal, seed, image, path, first_block);
}
#endif
