// The instrument's prescription as constants of the kernel: planes, spheres, missing aspheric terms and apertures fold
// away, and the rest are immediate operands. Rare fields (placement, dispersion, layers) stay in the uniform block.
// DeviceScene::specialised_constants gives the values of at most KNOWN_SURFACES surfaces.
layout(constant_id = CONSTANT_KNOWN_FIRST) const int known_first = 0; // the first surface that is known
layout(constant_id = CONSTANT_KNOWN_COUNT) const int known_count = 0; // number of surfaces known from there on

#define VKFV_DECLARE_CONSTANT(id, type, name) layout(constant_id = id) const type known_##name = type(0);
#define VKFV_KNOW(id, type, name) known.name = known_##name;
#define VKFV_KNOW_OF_LOBE(id, type, name) known.material.lobe_0.name = known_##name;
VKFV_KNOWN_OF_INSTRUMENT(VKFV_DECLARE_CONSTANT)
VKFV_KNOWN_OF_SPECIMEN(VKFV_DECLARE_CONSTANT)
VKFV_KNOWN_OF_LOBE(VKFV_DECLARE_CONSTANT)

#define VKFV_LEAVE(type, name)
#define VKFV_DECLARE_OF_SURFACE(k, place, type, name) \
    layout(constant_id = CONSTANT_KNOWN_SURFACES + KNOWN_FIELD_CAPACITY * k + place) const type name##_##k = type(0);
#define VKFV_KNOW_OF_SURFACE(k, place, type, name) surface.name = name##_##k;
#define VKFV_DECLARE_SURFACE(k) VKFV_SURFACE_FIELDS(VKFV_LEAVE, VKFV_DECLARE_OF_SURFACE, k)
#define VKFV_KNOW_SURFACE(k) VKFV_SURFACE_FIELDS(VKFV_LEAVE, VKFV_KNOW_OF_SURFACE, k)

// clang-format off
#define VKFV_EACH_KNOWN_SURFACE(M) \
    M(0) M(1) M(2) M(3) M(4) M(5) M(6) M(7) M(8) M(9) M(10) M(11) M(12) M(13) M(14) M(15) \
    M(16) M(17) M(18) M(19) M(20) M(21) M(22) M(23) M(24) M(25) M(26) M(27) M(28) M(29) M(30) M(31) \
    M(32) M(33) M(34) M(35) M(36) M(37) M(38) M(39) M(40) M(41) M(42) M(43) M(44) M(45) M(46) M(47) \
    M(48) M(49) M(50) M(51) M(52) M(53) M(54) M(55) M(56) M(57) M(58) M(59) M(60) M(61) M(62) M(63)
// clang-format on

VKFV_EACH_KNOWN_SURFACE(VKFV_DECLARE_SURFACE)
