// The instrument at hand as constants of the kernel: planes, spheres, missing aspheric terms and apertures fold away,
// and the rest are immediate operands. What few instruments have (placement, dispersion, layers) stays in the uniform
// block. DeviceScene::specialised_constants gives the values, KNOWN_SURFACES surfaces at most.
layout(constant_id = 88) const int known_first = 0; // the surfaces that follow are known_first ...
layout(constant_id = 89) const int known_count = 0; // ... known_first + known_count - 1
layout(constant_id = 90) const int known_illumination_first = 0;
layout(constant_id = 91) const int known_illumination_count = 0;
layout(constant_id = 92) const int known_imaging_first = 0;
layout(constant_id = 93) const int known_imaging_count = 0;
layout(constant_id = 94) const int known_max_bounces = 1;
layout(constant_id = 95) const float known_parameter_0 = 0.0; // of the material's first lobe
layout(constant_id = 96) const float known_parameter_1 = 0.0;
layout(constant_id = 97) const float known_parameter_2 = 0.0;
layout(constant_id = 98) const float known_parameter_3 = 0.0;

#define VKFV_DECLARE_SURFACE(k) \
    layout(constant_id = 100 + 16 * k) const float curvature_##k = 0.0; \
    layout(constant_id = 101 + 16 * k) const float conic_##k = 0.0; \
    layout(constant_id = 102 + 16 * k) const float semi_diameter_squared_##k = 0.0; \
    layout(constant_id = 103 + 16 * k) const float distance_##k = 0.0; \
    layout(constant_id = 104 + 16 * k) const float index_after_##k = 1.0; \
    layout(constant_id = 105 + 16 * k) const float a4_##k = 0.0; \
    layout(constant_id = 106 + 16 * k) const float a6_##k = 0.0; \
    layout(constant_id = 107 + 16 * k) const float a8_##k = 0.0; \
    layout(constant_id = 108 + 16 * k) const float a10_##k = 0.0; \
    layout(constant_id = 109 + 16 * k) const float a12_##k = 0.0; \
    layout(constant_id = 110 + 16 * k) const float a14_##k = 0.0; \
    layout(constant_id = 111 + 16 * k) const float a16_##k = 0.0; \
    layout(constant_id = 112 + 16 * k) const uint flags_##k = 0u; \
    layout(constant_id = 113 + 16 * k) const float bend_residual_##k = 0.0;

#define VKFV_KNOW_SURFACE(k) \
    surface.curvature = curvature_##k; \
    surface.conic = conic_##k; \
    surface.semi_diameter_squared = semi_diameter_squared_##k; \
    surface.distance = distance_##k; \
    surface.index_after = index_after_##k; \
    surface.a4 = a4_##k; \
    surface.a6 = a6_##k; \
    surface.a8 = a8_##k; \
    surface.a10 = a10_##k; \
    surface.a12 = a12_##k; \
    surface.a14 = a14_##k; \
    surface.a16 = a16_##k; \
    surface.flags = flags_##k; \
    surface.bend_residual = bend_residual_##k;

// clang-format off
#define VKFV_EACH_KNOWN_SURFACE(M) \
    M(0) M(1) M(2) M(3) M(4) M(5) M(6) M(7) M(8) M(9) M(10) M(11) M(12) M(13) M(14) M(15) \
    M(16) M(17) M(18) M(19) M(20) M(21) M(22) M(23) M(24) M(25) M(26) M(27) M(28) M(29) M(30) M(31) \
    M(32) M(33) M(34) M(35) M(36) M(37) M(38) M(39) M(40) M(41) M(42) M(43) M(44) M(45) M(46) M(47) \
    M(48) M(49) M(50) M(51) M(52) M(53) M(54) M(55) M(56) M(57) M(58) M(59) M(60) M(61) M(62) M(63)
// clang-format on

VKFV_EACH_KNOWN_SURFACE(VKFV_DECLARE_SURFACE)
