// Reflectance of the specimen where light meets it: a map's factor of the material's reflectance over x and y of the
// specimen frame, whatever the height; and the change of a material with the wavelength.

// The map's factor of the material's reflectance at a position: 1 without a map.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real reflectance_share(VKFV_SCENE_PARAMETER SpecimenRecord specimen, real3 position) {
    real share = real(1.0);
    if ((features(VKFV_SCENE_ALONE) & FEATURE_REFLECTANCE_MAP) != 0u) {
        share = pattern_factor(VKFV_SCENE specimen.reflectance, position.x, position.y);
    }
    return share;
}

// The material at a position: light that the map takes off is absorbed.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Material material_at(VKFV_SCENE_PARAMETER SpecimenRecord specimen, real3 position) {
    Material material = specimen.material;
    if ((features(VKFV_SCENE_ALONE) & FEATURE_REFLECTANCE_MAP) != 0u) {
        real share = reflectance_share(VKFV_SCENE specimen, position);
        material.lobe_0.weight = share * material.lobe_0.weight;
        material.lobe_1.weight = share * material.lobe_1.weight;
        material.lobe_2.weight = share * material.lobe_2.weight;
        material.lobe_3.weight = share * material.lobe_3.weight;
    }
    return material;
}

// A material's spectrum stands first among its numbers (material_number()): points of ascending wavelength, linear in
// between, and held beyond the ends. A point is the wavelength, um, then for each of the four lobes: the factor of its
// weight, and the real and the imaginary part of its refractive index, 0 where the model has none.
const int SPECTRAL_POINT_NUMBERS = 13;

struct SpectralPlace {
    int below;  // first number of the point below the wavelength
    real share; // fraction of the way to the next point
};

VKFV_SCENE_FUNCTION VKFV_FUNCTION SpectralPlace spectral_place(VKFV_SCENE_PARAMETER int points, real wavelength) {
    int first = 0;
    int last = points - 1;
    while (last - first > 1) {
        int middle = (first + last) / 2;
        if (wavelength < material_number(VKFV_SCENE SPECTRAL_POINT_NUMBERS * middle)) {
            last = middle;
        } else {
            first = middle;
        }
    }
    SpectralPlace place;
    place.below = SPECTRAL_POINT_NUMBERS * first;
    real start = material_number(VKFV_SCENE place.below);
    real stop = material_number(VKFV_SCENE place.below + SPECTRAL_POINT_NUMBERS);
    place.share = clamp((wavelength - start) / (stop - start), real(0.0), real(1.0));
    return place;
}

VKFV_SCENE_FUNCTION VKFV_FUNCTION real spectral_value(VKFV_SCENE_PARAMETER SpectralPlace place, int number) {
    return mix(material_number(VKFV_SCENE place.below + number),
               material_number(VKFV_SCENE place.below + SPECTRAL_POINT_NUMBERS + number), place.share);
}

// A lobe at one wavelength. number: index of the lobe's first value within a point.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Lobe lobe_at_wavelength(VKFV_SCENE_PARAMETER Lobe lobe, SpectralPlace place,
                                                          int number) {
    Lobe result = lobe;
    result.weight = lobe.weight * spectral_value(VKFV_SCENE place, number);
    if (lobe_has_index(lobe)) {
        result.parameter_0 = spectral_value(VKFV_SCENE place, number + 1);
        result.parameter_1 = spectral_value(VKFV_SCENE place, number + 2);
    }
    return result;
}

VKFV_FUNCTION Lobe lobe_in_medium(Lobe lobe, real index) {
    Lobe result = lobe;
    if (lobe_has_index(lobe)) {
        result.parameter_0 = lobe.parameter_0 / index;
        result.parameter_1 = lobe.parameter_1 / index;
    }
    return result;
}

// The material at the light's wavelength: its reflectance, and its refractive indices, which become relative to that of
// the medium over the specimen.
VKFV_SCENE_FUNCTION VKFV_FUNCTION Material material_of_light(VKFV_SCENE_PARAMETER Instrument instrument,
                                                             SpecimenRecord specimen, Material material, Light light) {
    Material result = material;
    if ((features(VKFV_SCENE_ALONE) & FEATURE_SPECTRAL_MATERIAL) != 0u) {
        SpectralPlace place =
            spectral_place(VKFV_SCENE specimen.material_spectral_points, real(1.0) / light.wave_number);
        result.lobe_0 = lobe_at_wavelength(VKFV_SCENE result.lobe_0, place, 1);
        result.lobe_1 = lobe_at_wavelength(VKFV_SCENE result.lobe_1, place, 4);
        result.lobe_2 = lobe_at_wavelength(VKFV_SCENE result.lobe_2, place, 7);
        result.lobe_3 = lobe_at_wavelength(VKFV_SCENE result.lobe_3, place, 10);
    }
    if ((scatter_models & SCATTER_INDEX) != 0u) {
        real index = instrument.specimen_index + disperse(instrument.specimen_dispersion, light.spectral);
        result.lobe_0 = lobe_in_medium(result.lobe_0, index);
        result.lobe_1 = lobe_in_medium(result.lobe_1, index);
        result.lobe_2 = lobe_in_medium(result.lobe_2, index);
        result.lobe_3 = lobe_in_medium(result.lobe_3, index);
    }
    return result;
}
