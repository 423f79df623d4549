// Images stored lying on a side or mirrored, as cameras do, made upright.
#pragma once

#include "core/mathematics/grid.hpp"

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <vector>

namespace vkfv::images::openimageio {

// The header's orientation (tag 274 of TIFF 6.0 and Exif): which sides of the picture, as it is shown, the stored first
// row and first column are. 1 (top and left) where there is none or it is none of the eight.
inline int orientation_of(const OIIO::ImageSpec& spec) {
    const int orientation = spec.get_int_attribute("Orientation", 1);
    return orientation >= 1 && orientation <= 8 ? orientation : 1;
}

// Values from the stored first row on become the picture as it is shown, row 0 lowest. From 5 on rows are columns.
template <class Value, class Stored>
Grid<Value> upright(const std::vector<Stored>& stored, int width, int height, int orientation) {
    const bool turned = orientation >= 5;
    Grid<Value> shown(turned ? height : width, turned ? width : height);
    // Which side the stored column counts from, and the stored row, as TIFF 6.0 names them.
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
