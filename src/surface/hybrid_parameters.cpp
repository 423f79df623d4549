#include "surface/hybrid_parameters.hpp"

#include <cmath>
#include <limits>

namespace vkfv::surface {

HybridParameters hybrid_parameters(const HeightMap& map) {
    double triangles = 0, squares = 0, excess = 0;
    const auto add_triangle = [&](double along_x, double along_y) {
        const double square = along_x * along_x + along_y * along_y;
        squares += square;
        excess += square / (1 + std::sqrt(1 + square)); // sqrt(1 + square) - 1 without cancellation
        triangles += 1;
    };
    for (int row = 0; row + 1 < map.rows(); ++row)
        for (int column = 0; column + 1 < map.columns(); ++column) {
            const double a = map.height(column, row), b = map.height(column + 1, row);
            const double c = map.height(column, row + 1), d = map.height(column + 1, row + 1);
            if (!std::isfinite(a + b + c + d))
                continue;
            const double below = (b - a) / map.pitch_x, above = (d - c) / map.pitch_x;
            const double left = (c - a) / map.pitch_y, right = (d - b) / map.pitch_y;
            add_triangle(below, (left + right) / 2);
            add_triangle(above, (left + right) / 2);
            add_triangle((below + above) / 2, left);
            add_triangle((below + above) / 2, right);
        }
    if (triangles == 0)
        return {.sdq = std::numeric_limits<double>::quiet_NaN(), .sdr = std::numeric_limits<double>::quiet_NaN()};
    return {.sdq = std::sqrt(squares / triangles), .sdr = excess / triangles};
}

} // namespace vkfv::surface
