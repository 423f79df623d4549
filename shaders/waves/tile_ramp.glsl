// Blending of the images of a few filters (optics/waves/field_tiles.hpp) along one direction of an image. The image is
// divided into windows, each of which lies between two points of the field that have a filter, and fades into the next
// windows.
// clang-format off
#define VKFV_TILE_RAMP_FIELDS(FIELD) \
    FIELD(real, from)        /* place of the first point, pixels from the image's border */ \
    FIELD(real, width)       /* pixels to the second one; 0: there is one filter */ \
    FIELD(real, fade)        /* pixels, half of those in which two windows share the image */ \
    FIELD(uint, neighbours)  /* 1: there is a window before, 2: one after, 3: both */
struct TileRamp {
    VKFV_TILE_RAMP_FIELDS(VKFV_DECLARE)
};
// clang-format on

// The weights of the filters of the first and of the second point at a place, pixels from the image's border. The
// weights of all windows add up to 1.
VKFV_FUNCTION real2 tile_weights(TileRamp ramp, real place) {
    real share = real(1.0);
    if ((ramp.neighbours & 1u) != 0u) {
        share *= clamp(real(0.5) + real(0.5) * (place - ramp.from) / ramp.fade, real(0.0), real(1.0));
    }
    if ((ramp.neighbours & 2u) != 0u) {
        share *= clamp(real(0.5) - real(0.5) * (place - ramp.from - ramp.width) / ramp.fade, real(0.0), real(1.0));
    }
    real second = ramp.width > real(0.0) ? clamp((place - ramp.from) / ramp.width, real(0.0), real(1.0)) : real(0.0);
    return real2(share * (real(1.0) - second), share * second);
}
