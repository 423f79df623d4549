// Maps of standards as an instrument would give them: tilted, noisy, with gaps, and turned.
#pragma once

#include "dimensions/feature.hpp"

#include <algorithm>
#include <random>

namespace vkfv::dimensions::test {

inline constexpr double degrees = 3.14159265358979323846 / 180;

struct Disturbance {
    double tilt_x = 0, tilt_y = 0;
    double noise = 0; // standard deviation, mm
    double gaps = 0;  // share of the points that are not measured
    unsigned seed = 1;
};

// Makes a map of 200 x 150 points, 2 um apart: not square, and not about the frame's origin.
template <class Height>
surface::HeightMap made(const Frame& frame, const Height& height, const Disturbance& disturbance = {}) {
    surface::HeightMap map{
        .height = Grid<double>(200, 150), .x0 = -0.21, .y0 = -0.14, .pitch_x = 0.002, .pitch_y = 0.002};
    std::mt19937_64 random(disturbance.seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            const double x = map.x(column), y = map.y(row);
            const double z = height(frame.u(x, y), frame.v(x, y)) + disturbance.tilt_x * x + disturbance.tilt_y * y +
                             disturbance.noise * normal(random) + 3.7;
            map.height(column, row) = uniform(random) < disturbance.gaps ? surface::undefined : z;
        }
    return map;
}

// A groove with flanks `wall` wide, its edges at half depth at +-width / 2.
inline double groove_height(const Groove& groove, double wall, double u) {
    return -groove.depth * std::clamp((groove.width / 2 - std::abs(u)) / wall + 0.5, 0.0, 1.0);
}

} // namespace vkfv::dimensions::test
