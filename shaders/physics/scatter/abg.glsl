// The ABg model of scatter by polished surfaces, used by programs of optical design (R. Pfisterer, "Approximated
// scatter models for stray light analysis", Opt. Photon. News 22 (10) (2011) 16):
//   f = A / (B + d^g),
// where d is the distance of the outgoing direction's cosines from the mirror direction's. A makes the integral of f
// cos(theta) 1 at normal incidence, so that the lobe's weight is the total integrated scatter. The model is reciprocal;
// at other incidences the part of the lobe beyond the horizon is absorbed. The unscattered light is a lobe of mirror.
// parameter: abg_b, 1e-12, 1, 0.001, constant B: the lobe rolls off at the distance of direction cosines B^(1/g)
// parameter: abg_g, 0.1, 8, 1.5, exponent g: the lobe falls with this power of that distance
// absorbs
// table

// d^g, for a distance d > 0.
VKFV_FUNCTION real abg_power(real abg_g, real distance) { return exp(abg_g * log(max(distance, real(1e-30)))); }

// Proposals have the density 1 / B up to the roll-off and d^-g from there to 1, which is nowhere more than twice the
// wanted density. y = -log(d), and y_0 is its value at the roll-off.
struct AbgProposal {
    real distance;
    real acceptance;
};
VKFV_FUNCTION AbgProposal abg_proposal(real abg_b, real abg_g, real u) {
    real y_0 = -log(abg_b) / abg_g;
    real q = real(2.0) - abg_g;
    bool even = abs(q) < real(1e-6);
    real inner = real(0.5) * exp(-q * y_0);
    real outer = even ? y_0 : -exp_minus_one(-q * y_0) / q;
    real place = u * (inner + outer);
    real beyond = max(inner + outer - place, real(0.0)); // mass of the proposals between this place and d = 1
    real y = real(0.0);
    if (place < inner) {
        y = y_0 - real(0.5) * log(max(place / inner, real(1e-30)));
    } else {
        // exp(-q y) is taken from that end of the range at which its digits are not lost.
        bool far = q * beyond > real(0.25);
        real grown = far ? log(q * (place - inner) + exp(-q * y_0)) : log_one_plus(-q * beyond);
        y = even ? beyond : -grown / q;
    }
    AbgProposal proposal;
    proposal.distance = min(exp(-y), real(1.0));
    real power = exp(-abg_g * y);
    proposal.acceptance = (place < inner ? abg_b : power) / (abg_b + power);
    return proposal;
}

VKFV_FUNCTION ScatterTry abg_try(real abg_b, real abg_g, Incidence incidence, real u0, real u1, real u2) {
    AbgProposal proposal = abg_proposal(abg_b, abg_g, u0);
    CosinesDraw drawn = draw_in_cosines(incidence, proposal.distance, u1);
    bool proposed = u2 < proposal.acceptance;
    bool kept = drawn.above;
    if (drawn.folded) {
        real ratio = (abg_b + abg_power(abg_g, proposal.distance)) / (abg_b + abg_power(abg_g, drawn.distance));
        kept = kept && u2 < proposal.acceptance * ratio;
    }
    ScatterTry result;
    result.direction = drawn.direction;
    result.accepted = proposed && kept;
    result.absorbed = proposed && !kept;
    return result;
}

// The BSDF; A is table[0].
VKFV_FUNCTION real abg_bsdf(real abg_b, real abg_g, real table[LOBE_TABLE_SIZE], Incidence incidence, real3 outgoing) {
    return table[0] / (abg_b + abg_power(abg_g, sqrt(cosines_apart_squared(incidence, outgoing))));
}
