// A rough surface known everywhere in closed form: a sum of waves of random direction and phase.
#pragma once

#include "core/mathematics/units.hpp"
#include "surface/height_map.hpp"

#include <cmath>
#include <random>
#include <vector>

namespace vkfv::topography::test {

struct Wave {
    double amplitude, frequency_x, frequency_y, phase; // mm, 1/mm
    double frequency() const { return std::hypot(frequency_x, frequency_y); }
};

// Waves with frequencies evenly over the disc's ring from `lowest` to `highest`, 1/mm.
inline std::vector<Wave> random_waves(int count, double lowest, double highest, double amplitude, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> share;
    std::vector<Wave> waves;
    for (int k = 0; k < count; ++k) {
        const double frequency = std::sqrt(std::lerp(lowest * lowest, highest * highest, share(random)));
        const double direction = 2 * pi * share(random);
        waves.push_back(
            {amplitude, frequency * std::cos(direction), frequency * std::sin(direction), 2 * pi * share(random)});
    }
    return waves;
}

template <class Transfer>
surface::HeightMap map_of(const std::vector<Wave>& waves, int columns, int rows, double pitch, double shift_x,
                          double shift_y, const Transfer& transfer) {
    surface::HeightMap map{.height = Grid<double>(columns, rows), .x0 = 0, .y0 = 0, .pitch_x = pitch, .pitch_y = pitch};
    for (const Wave& wave : waves) {
        const double amplitude = wave.amplitude * transfer(wave.frequency());
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                map.height(column, row) += amplitude * std::cos(2 * pi *
                                                                    (wave.frequency_x * (map.x(column) - shift_x) +
                                                                     wave.frequency_y * (map.y(row) - shift_y)) +
                                                                wave.phase);
    }
    return map;
}

} // namespace vkfv::topography::test
