// What a map leaves of the material's reflectance where light meets the specimen: a factor over x and y of the specimen
// frame, whatever the height.

// The share of its material's reflectance that the specimen has there: 1 without a map.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real reflectance_share(VKFV_SCENE_PARAMETER SpecimenRecord specimen, real3 position) {
    real share = real(1.0);
    if ((features(VKFV_SCENE_ALONE) & FEATURE_REFLECTANCE_MAP) != 0u) {
        share = pattern_factor(VKFV_SCENE specimen.reflectance, position.x, position.y);
    }
    return share;
}

// The material there: what the map takes is absorbed.
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
