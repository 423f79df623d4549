// Turns images upright that are stored rotated or mirrored, as cameras store them.
#pragma once

#include "core/mathematics/grid.hpp"

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <vector>

namespace vkfv::images::openimageio {

// The header's orientation (tag 274 of TIFF 6.0 and Exif): the sides of the displayed picture at which the first stored
// row and column lie. 1 (top and left) if it is missing or none of the eight.
inline int orientation_of(const OIIO::ImageSpec& spec) {
    const int orientation = spec.get_int_attribute("Orientation", 1);
    return orientation >= 1 && orientation <= 8 ? orientation : 1;
}

// Converts values from the first stored row onwards to the displayed picture, row 0 lowest. Orientations 5 to 8
// exchange rows and columns.
template <class Value, class Stored>
Grid<Value> upright(const std::vector<Stored>& stored, int width, int height, int orientation) {
    const bool turned = orientation >= 5;
    Grid<Value> shown(turned ? height : width, turned ? width : height);
    // The sides from which the stored columns and rows count, as TIFF 6.0 names them.
    const bool from_right = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
    const bool from_bottom = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
    std::size_t place = 0;
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column, ++place) {
            const int x = turned ? row : column, y = turned ? column : row;
            shown(from_right ? shown.columns - 1 - x : x, from_bottom ? y : shown.rows - 1 - y) =
                static_cast<Value>(stored[place]);
        }
    }
    return shown;
}

} // namespace vkfv::images::openimageio
