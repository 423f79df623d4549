// Functions that the models of scatter/ are made of, and the rules for a model. A model is one file there, named as in
// a configuration with _ for -; the build finds it, and so do the reader, the kernels and the tests. It has a line for
// each parameter, at most four,
//   // parameter: NAME, MINIMUM, MAXIMUM, DEFAULT, MEANING
// the line `// delta` where a direction is certain and has no density, and two functions, the parameters first:
//   ScatterTry NAME_try(parameters..., Incidence incidence, real u0, real u1, real u2)
//     one try of a rejection; the accepted directions lie above the surface and have the density
//   real NAME_bsdf(parameters..., Incidence incidence, real3 outgoing)
//     asked for above the surface alone, 1/sr: the density per sr of the outgoing direction divided by its cosine, so
//     that the integral of bsdf * cosine over the hemisphere is 1; a delta has 0
// The line `// lossy` says that the first try decides: light that it does not accept is absorbed, and the integral is
// the share that is accepted. With the line `// absorbs` the integral is that share too, but tries say themselves which
// light is absorbed. With the line `// table`, NAME_bsdf takes `real table[LOBE_TABLE_SIZE]` after the parameters, and
// the host fills it: src/specimen/scatter_tables.cpp. With the line `// drawn_by_table`, NAME_try takes it too.

// With the line `// cone`, NAME_cone(parameters..., [table,] Incidence incidence, real versine, real u0, real u1) draws
// a direction within the cone of that versine (1 - cos of its half angle) about the mirror direction: ConeDraw.

// The line `// index` says that the first two parameters are the real and the imaginary part of a refractive index over
// that of the medium: material_of_light() divides by it. With the line `// numbers` both functions take VKFV_SCENE
// first and may read material_number(), numbers that the host has read from a file (src/specimen/tabulated_bsdf.cpp);
// the table has the index of the first.

// The models of the specimen's material: bit k for model k, and SCATTER_CHOICE unless it is one lobe that reflects
// everything. A kernel is compiled without the others.
const uint SCATTER_CHOICE = 0x80000000u;
const uint SCATTER_DELTA = 0x40000000u; // set where a lobe is a delta
const uint SCATTER_INDEX = 0x20000000u; // set where a lobe has a refractive index
#ifdef __cplusplus
const uint scatter_models = 0xFFFFFFFFu;
#else
layout(constant_id = CONSTANT_SCATTER_MODELS) const uint scatter_models = 0xFFFFFFFFu;
#endif

// Light on its way from the source to the surface, all unit vectors.
struct Incidence {
    real3 incoming; // towards the surface
    real3 normal;   // on the side the light comes from
    real3 mirror;   // away from the surface
};

struct ScatterTry {
    bool accepted;
    bool absorbed;   // true: the light is absorbed; if neither holds, there is another try
    real3 direction; // unit
};

#ifdef __cplusplus
template <class Scene>
real material_number(const Scene& scene, int index) {
    return scene.material_number(index);
}

// The scene for models that read no numbers.
struct NoNumbers {
    real material_number(int /*index*/) const { return real(0.0); }
};
#else
real material_number(int index); // the kernel's bindings say where the numbers are kept
#endif

// A direction drawn within a cone, and the wanted density there over the density that it was drawn by: the probability
// of acceptance, if it is nowhere above 1.
struct ConeDraw {
    real bound; // upper bound of the ratio; 0: the model cannot draw within a cone
    real ratio;
    real3 direction; // unit
};

VKFV_FUNCTION real3 mirrored(real3 direction, real3 unit_normal) {
    return direction - unit_normal * (real(2.0) * dot(direction, unit_normal));
}

VKFV_FUNCTION Incidence make_incidence(real3 incoming, real3 normal) {
    Incidence incidence;
    incidence.incoming = incoming;
    incidence.normal = normal;
    incidence.mirror = mirrored(incoming, normal);
    return incidence;
}

struct Frame {
    real3 first;
    real3 second;
};

// An orthonormal basis: two unit vectors at right angles to the unit vector w, by T. Duff et al., "Building an
// orthonormal basis, revisited", JCGT 6 (2017) 1.
VKFV_FUNCTION Frame frame_around(real3 w) {
    real sign_z = w.z >= real(0.0) ? real(1.0) : real(-1.0);
    real a = real(-1.0) / (sign_z + w.z);
    real b = w.x * w.y * a;
    Frame frame;
    frame.first = real3(real(1.0) + sign_z * w.x * w.x * a, sign_z * b, -sign_z * w.x);
    frame.second = real3(b, sign_z + w.y * w.y * a, -w.y);
    return frame;
}

// Unit vector at the angle of the given versine (1 - cos) from the unit vector axis, at the azimuth of a share of a
// turn.
VKFV_FUNCTION real3 direction_around(real3 axis, real versine, real azimuth) {
    Frame frame = frame_around(axis);
    real sine = sqrt(max(versine * (real(2.0) - versine), real(0.0)));
    Turn phi = turn_of(azimuth);
    return axis * (real(1.0) - versine) + frame.first * (sine * phi.cosine) + frame.second * (sine * phi.sine);
}

// exp(x) - 1 and log(1 + x) without cancellation near 0, to 1e-10 of their values.
VKFV_FUNCTION real exp_minus_one(real x) {
    real series = real(1.0) + x * real(0.125);
    series = real(1.0) + x * real(0.142857142857142857) * series;
    series = real(1.0) + x * real(0.166666666666666667) * series;
    series = real(1.0) + x * real(0.2) * series;
    series = real(1.0) + x * real(0.25) * series;
    series = real(1.0) + x * real(0.333333333333333333) * series;
    series = real(1.0) + x * real(0.5) * series;
    return abs(x) < real(0.25) ? x * series : exp(x) - real(1.0);
}

VKFV_FUNCTION real log_one_plus(real x) {
    real z = x / (real(2.0) + x);
    real square = z * z;
    real series =
        real(0.142857142857142857) + square * (real(0.111111111111111111) + square * real(0.0909090909090909));
    series = real(1.0) + square * (real(0.333333333333333333) + square * (real(0.2) + square * series));
    return abs(x) < real(0.25) ? real(2.0) * z * series : log(real(1.0) + x);
}

// Lobes over the plane of direction cosines: their BSDF depends only on the distance of the outgoing direction's
// cosines from the mirror direction's, and falls with it. Cosines are the parts of unit vectors along the surface.

// Squared distance of the outgoing direction's cosines from the mirror direction's.
VKFV_FUNCTION real cosines_apart_squared(Incidence incidence, real3 outgoing) {
    real3 apart = outgoing - incidence.mirror;
    apart = apart - incidence.normal * dot(apart, incidence.normal);
    return dot(apart, apart);
}

struct CosinesDraw {
    bool folded;     // true: folded to a larger distance than that which was drawn
    real distance;   // distance of the direction's cosines from the mirror direction's
    bool above;      // true: above the surface
    real3 direction; // unit
};

// Draws the direction at a distance of at most 1, at the azimuth of a share of a turn. Cosines beyond the unit circle
// belong to no direction. The line halfway between the circle's centre and the mirror direction's cosines mirrors them
// onto cosines within the circle that are more than 1 from the mirror direction's, which no draw gives: where a draw is
// folded and accepted with the quotient of both distances' BSDF as its probability, all directions have their density.
VKFV_FUNCTION CosinesDraw draw_in_cosines(Incidence incidence, real distance, real azimuth) {
    real incoming_cosine = -dot(incidence.incoming, incidence.normal);
    real3 centre = incidence.incoming + incidence.normal * incoming_cosine;
    Frame frame = frame_around(incidence.normal);
    Turn turn = turn_of(azimuth);
    real3 offset = frame.first * (distance * turn.cosine) + frame.second * (distance * turn.sine);
    real3 cosines = centre + offset;
    real length_squared = dot(cosines, cosines);
    real centre_squared = dot(centre, centre);
    CosinesDraw result;
    result.folded = length_squared > real(1.0) && centre_squared > real(0.0);
    result.distance = distance;
    if (result.folded) {
        result.distance = sqrt(length_squared);
        cosines = cosines - centre * (real(2.0) * dot(cosines, centre) / centre_squared - real(1.0));
        offset = cosines - centre;
    }
    // height_squared is 1 - dot(cosines, cosines), in a form that is exact near grazing incidence too.
    real height_squared = incoming_cosine * incoming_cosine - dot(offset, centre + cosines);
    result.above = height_squared > real(0.0);
    result.direction = cosines + incidence.normal * sqrt(max(height_squared, real(0.0)));
    return result;
}
