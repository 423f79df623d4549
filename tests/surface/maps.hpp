// Height maps for tests.
#pragma once

#include "surface/height_map.hpp"

#include <limits>
#include <random>

namespace vkfv::surface::test {

inline constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

template <class Function>
HeightMap sampled(int columns, int rows, double pitch, const Function& function) {
    HeightMap map{.height = Grid<double>(columns, rows), .x0 = -0.3, .y0 = 0.2, .pitch_x = pitch, .pitch_y = pitch};
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            map.height(column, row) = function(map.x(column), map.y(row));
    return map;
}

inline void forget_a_third(HeightMap& map) {
    std::mt19937 random(3);
    for (double& height : map.height.values)
        if (random() % 3 == 0)
            height = not_measured;
}

} // namespace vkfv::surface::test
