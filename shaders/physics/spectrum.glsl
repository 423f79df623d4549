// Wavelengths: the draw from the source's spectrum, and the spectral quantities that follow from it.

#ifdef __cplusplus
template <class Scene>
SpectralBin spectral_bin(const Scene& scene, int index) {
    return scene.spectral_bin(index);
}
template <class Scene>
uint features(const Scene& scene) {
    return scene.features();
}
#else
SpectralBin spectral_bin(int index); // bindings.glsl
uint features();                     // FEATURE_* of the scene: bindings.glsl
#endif

VKFV_FUNCTION Light light_of_wave_number(Instrument instrument, real wave_number) {
    Light light;
    light.wave_number = wave_number;
    light.spectral = (wave_number * wave_number - instrument.spectrum_centre) / instrument.spectrum_half_width;
    light.survival = real(0.0);
    return light;
}

VKFV_FUNCTION Light light_of_spectral(Instrument instrument, real spectral) {
    Light light;
    light.wave_number = sqrt(instrument.spectrum_centre + spectral * instrument.spectrum_half_width);
    light.spectral = spectral;
    light.survival = real(0.0);
    return light;
}

// The wavelength (um) that the share u of a bin's flux lies below.
VKFV_FUNCTION real wavelength_in_bin(SpectralBin bin, real u) {
    real low = real(1.0) - bin.tilt;
    real place = real(2.0) * u / (low + sqrt(max(low * low + real(4.0) * bin.tilt * u, real(0.0))));
    return bin.start + place * (bin.stop - bin.start);
}

// Draws light from the spectrum by the inverse of its cumulative distribution; u uniform in (0, 1).
VKFV_SCENE_FUNCTION VKFV_FUNCTION Light draw_light(VKFV_SCENE_PARAMETER Instrument instrument, real u) {
    int first = 0;
    int last = instrument.spectral_bins - 1;
    while (first < last) {
        int middle = (first + last) / 2;
        if (u <= spectral_bin(VKFV_SCENE middle).cumulative) {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    SpectralBin bin = spectral_bin(VKFV_SCENE first);
    real before = real(0.0);
    if (first > 0) {
        before = spectral_bin(VKFV_SCENE first - 1).cumulative;
    }
    real share = clamp((u - before) / (bin.cumulative - before), real(0.0), real(1.0));
    return light_of_wave_number(instrument, real(1.0) / wavelength_in_bin(bin, share));
}

// The difference between the index at spectral coordinate x and that at x = 0.
VKFV_FUNCTION real disperse(Dispersion dispersion, real x) {
    return x *
           (dispersion.c1 +
            x * (dispersion.c2 + x * (dispersion.c3 + x * (dispersion.c4 + x * (dispersion.c5 + x * dispersion.c6)))));
}
