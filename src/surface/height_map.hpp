// A height map: measured or true heights over a regular grid.
#pragma once

#include "core/mathematics/grid.hpp"

#include <limits>

namespace vkfv::surface {

// The value of a figure for which the map has too few points.
inline constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

// Heights in mm over the specimen frame's x and y in mm. NaN means "not measured".
// Point (i, j) stands at (x0 + i * pitch_x, y0 + j * pitch_y); rows ascend with y.
struct HeightMap {
    Grid<double> height;
    double x0 = 0;
    double y0 = 0;
    double pitch_x = 0;
    double pitch_y = 0;

    int columns() const { return height.columns; }
    int rows() const { return height.rows; }
    double x(int column) const { return x0 + column * pitch_x; }
    double y(int row) const { return y0 + row * pitch_y; }
};

} // namespace vkfv::surface
