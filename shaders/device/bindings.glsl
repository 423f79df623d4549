// What the kernels of the trace are bound to (set 0). device_specimen.hpp binds 8 to 13.
// Uniform blocks, since every lane reads the same surface: gathered lane by lane it would take longer than the optics.
layout(set = 0, binding = 0, scalar) uniform Surfaces { Surface surfaces[SURFACE_CAPACITY]; };
layout(set = 0, binding = 1, scalar) uniform Parameters {
    Instrument instrument;
    SpecimenRecord specimen;
    Exposure exposure;
};
layout(set = 0, binding = 14, scalar) uniform Spectrum { SpectralBin spectrum[SPECTRUM_CAPACITY]; };

layout(constant_id = 3) const uint scene_features = 0u; // FEATURE_*: what is absent is compiled out

Surface surface_at(int index) { return surfaces[index]; }
SpectralBin spectral_bin(int index) { return spectrum[index]; }
uint features() { return scene_features; }
