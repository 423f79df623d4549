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

// Both with what the kernel knows as constants.
Instrument known_instrument() {
    Instrument known = instrument;
#ifdef VKFV_SPECIALISED
    known.illumination_first = known_illumination_first;
    known.illumination_count = known_illumination_count;
    known.imaging_first = known_imaging_first;
    known.imaging_count = known_imaging_count;
#endif
    return known;
}
SpecimenRecord known_specimen() {
    SpecimenRecord known = specimen;
#ifdef VKFV_SPECIALISED
    known.max_bounces = known_max_bounces;
    known.material.lobe_0.parameter_0 = known_parameter_0;
    known.material.lobe_0.parameter_1 = known_parameter_1;
    known.material.lobe_0.parameter_2 = known_parameter_2;
    known.material.lobe_0.parameter_3 = known_parameter_3;
#endif
    return known;
}
