// The light field: the light that the plane of the illumination's field stop lets through. It is a pattern, which the
// lenses image onto the specimen, and a fall-off with the square of the distance from its brightest place.

#ifdef __cplusplus
template <class Scene>
LightField light_field(const Scene& scene) {
    return scene.light_field();
}
#else
LightField light_field(); // light field of the instrument
#endif

// The share of light that the field lets through. x, y: mm, in the plane's frame of the light from the source.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real light_field_share(VKFV_SCENE_PARAMETER LightField field, real x, real y) {
    real from_x = x - field.brightest_x;
    real from_y = y - field.brightest_y;
    real even = max(real(1.0) - field.falloff * (from_x * from_x + from_y * from_y), real(0.0));
    return even * pattern_factor(VKFV_SCENE field.pattern, x, y);
}

// The share of light that goes on through a surface at x and y of the surface's frame: 1 but in the field's plane.
VKFV_SCENE_FUNCTION VKFV_FUNCTION real light_field_at(VKFV_SCENE_PARAMETER Surface surface, real x, real y) {
    real share = real(1.0);
    if ((features(VKFV_SCENE_ALONE) & FEATURE_LIGHT_FIELD) != 0u && (surface.flags & SURFACE_LIGHT_FIELD) != 0u) {
        bool turned = (surface.flags & SURFACE_TURNED) != 0u;
        share = light_field_share(VKFV_SCENE light_field(VKFV_SCENE_ALONE), x, turned ? -y : y);
    }
    return share;
}
