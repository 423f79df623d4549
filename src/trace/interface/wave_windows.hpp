// The windows of an image of waves in which filters of the field's points are blended.
#pragma once

#include "core/mathematics/pixel_grid.hpp"
#include "waves/tile_ramp.hpp"

#include <array>
#include <vector>

namespace vkfv::trace {

// A rectangle of pixels, transformed by itself, of which a margin lies in the next windows: beyond its border the light
// is not known, but goes on as its mirror image, and what a filter spreads from there is to count for little.
struct WaveWindow {
    int column = 0; // first
    int row = 0;
    ImageSize size;
    int filters = 1;            // that are blended in it: one or four
    std::array<int, 4> tiles{}; // their numbers: at the lower left, lower right, upper left, upper right
    waves::f64::TileRamp along;
    waves::f64::TileRamp up;
};

// The windows of an image of so many pixels, each of so many parts a side, with so many tiles across the field
// (optics::FieldTiles::across()). All are of one size, whose weights add up to 1 at every pixel. One tile: the whole
// image.
std::vector<WaveWindow> wave_windows(int tiles, ImageSize pixels, int parts);

// The weights of the window's four filters at a pixel of the image.
std::array<double, 4> weights_at(const WaveWindow& window, int column, int row);

} // namespace vkfv::trace
