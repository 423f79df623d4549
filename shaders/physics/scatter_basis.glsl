// What the models of scatter/ are made of. A model is one file there, named as in a configuration with _ for -; the
// build finds it, and with it the reader, the kernels and the tests do. It has a line for each parameter, at most four,
//   // parameter: NAME, MINIMUM, MAXIMUM, DEFAULT, MEANING
// the line `// delta` where a direction is certain and has no density, and two functions, the parameters first:
//   ScatterTry NAME_try(parameters..., Incidence incidence, real u0, real u1, real u2)
//     one try of a rejection; the accepted directions lie above the surface and have the density
//   real NAME_bsdf(parameters..., Incidence incidence, real3 outgoing)
//     asked for above the surface alone, 1/sr: the density per sr of the outgoing direction divided by its cosine, so
//     that the integral of bsdf * cosine over the hemisphere is 1; a delta has 0
// The line `// lossy` says that the first try decides: what it does not accept is absorbed, and the integral is the
// share that is accepted. With the line `// table`, NAME_bsdf takes `real table[LOBE_TABLE_SIZE]` after the parameters,
// and the host fills it: src/specimen/scatter_tables.cpp.

// With the line `// cone`, NAME_cone(parameters..., [table,] Incidence incidence, real versine, real u0, real u1) draws
// a direction within the cone of that versine (1 - cos of its half angle) about the mirror direction: ConeDraw.

// The models that the specimen's material has, bit k for model k, and SCATTER_CHOICE unless it is one lobe that
// reflects everything: what it has not is compiled out of a kernel.
const uint SCATTER_CHOICE = 0x80000000u;
const uint SCATTER_DELTA = 0x40000000u; // set where a lobe is a delta
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
    real3 direction; // unit
};

// A direction drawn within a cone, and the density that is wanted there over the density that it was drawn by: the
// chance by which it is kept, if it is nowhere above 1.
struct ConeDraw {
    real bound; // no ratio is larger; 0: the model draws no such directions
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

// Two unit vectors at right angles to the unit vector w: T. Duff et al., "Building an orthonormal basis, revisited",
// JCGT 6 (2017) 1.
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
