// The windows of a wave image in which filters of the field's points are blended.
#pragma once

#include "core/mathematics/pixel_grid.hpp"
#include "waves/tile_ramp.hpp"

#include <array>
#include <vector>

namespace vkfv::trace {

// A rectangle of pixels that is transformed by itself, with a margin that lies in the next windows. Beyond its border
// the light is unknown and continued as its mirror image; the margin keeps light that a filter spreads from there at
// low weight.
struct WaveWindow {
    int column = 0; // first column
    int row = 0;
    ImageSize size;
    int filters = 1;            // number of filters blended in it: one or four
    std::array<int, 4> tiles{}; // tile numbers at the lower left, lower right, upper left, upper right
    waves::f64::TileRamp along;
    waves::f64::TileRamp up;
};

// The windows of an image of so many pixels, each of `parts` parts a side, with `tiles` tiles across the field
// (optics::FieldTiles::across()). All are of one size; their weights add up to 1 at every pixel. One tile: the whole
// image.
std::vector<WaveWindow> wave_windows(int tiles, ImageSize pixels, int parts);

// The weights of the window's four filters at a pixel of the image.
std::array<double, 4> weights_at(const WaveWindow& window, int column, int row);

} // namespace vkfv::trace
