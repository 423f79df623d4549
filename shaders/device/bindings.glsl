// What the kernels of the trace are bound to (set 0). device_specimen.hpp binds 8 and up.
layout(set = 0, binding = 0, scalar) readonly buffer Surfaces { Surface surfaces[]; };
layout(set = 0, binding = 1, scalar) uniform Parameters {
    Instrument instrument;
    SpecimenRecord specimen;
    Exposure exposure;
};

Surface surface_at(int index) { return surfaces[index]; }
