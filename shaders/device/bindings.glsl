// What the kernels of the trace are bound to (set 0). device_specimen.hpp binds 8 and up.
// Uniform blocks, since every lane reads the same surface: gathered lane by lane it would take longer than the optics.
layout(set = 0, binding = 0, scalar) uniform Surfaces { Surface surfaces[SURFACE_CAPACITY]; };
layout(set = 0, binding = 1, scalar) uniform Parameters {
    Instrument instrument;
    SpecimenRecord specimen;
    Exposure exposure;
};

Surface surface_at(int index) { return surfaces[index]; }
