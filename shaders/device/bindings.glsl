// Every kernel of the trace includes this file first: the physics, the records shared with the host, and the bindings.
#extension GL_EXT_scalar_block_layout : require
#include "physics/lang.glsl"
#include "device/numbers.glsl"
#include "physics/all.glsl"
#include "device/blocks.glsl"

// Uniform blocks, since every lane reads the same surface: gathered lane by lane it would take longer than the optics.
layout(set = 0, binding = BINDING_SURFACES, scalar) uniform Surfaces { Surface surfaces[SURFACE_CAPACITY]; };
// clang-format off
layout(set = 0, binding = BINDING_PARAMETERS, scalar) uniform Parameters {
    VKFV_PARAMETERS_FIELDS(VKFV_DECLARE)
};
// clang-format on
layout(set = 0, binding = BINDING_SPECTRUM, scalar) uniform Spectrum { SpectralBin spectrum[SPECTRUM_CAPACITY]; };

layout(constant_id = CONSTANT_FEATURES) const uint scene_features = 0u; // FEATURE_*: absent features are compiled out

Surface surface_at(int index) { return surfaces[index]; }
SpectralBin spectral_bin(int index) { return spectrum[index]; }
LightField light_field() { return instrument.light_field; }
uint features() { return scene_features; }

// Instrument and specimen with those fields replaced that a specialised kernel knows as constants.
Instrument known_instrument() {
    Instrument known = instrument;
#ifdef VKFV_SPECIALISED
    VKFV_KNOWN_OF_INSTRUMENT(VKFV_KNOW)
#endif
    return known;
}
SpecimenRecord known_specimen() {
    SpecimenRecord known = specimen;
#ifdef VKFV_SPECIALISED
    VKFV_KNOWN_OF_SPECIMEN(VKFV_KNOW)
    VKFV_KNOWN_OF_LOBE(VKFV_KNOW_OF_LOBE)
#endif
    return known;
}
