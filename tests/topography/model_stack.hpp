// Stacks made without optics, whose contrast in every pixel is a Gaussian along z around its height.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/mathematics/units.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vkfv::topography::test {

inline constexpr int side = 72;

struct ModelStack {
    std::vector<Grid<float>> images;
    std::vector<double> z; // in steps
    Grid<double> height;   // likewise
};

// White noise averaged with its neighbours, of standard deviation 1.
inline Grid<double> texture_of(std::mt19937& random) {
    std::normal_distribution<double> normal;
    Grid<double> white(side, side), result(side, side);
    for (double& value : white.values) {
        value = normal(random);
    }
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const auto at = [&](int i, int j) { return white((i + side) % side, (j + side) % side); };
            result(column, row) = (2 * at(column, row) + at(column + 1, row) + at(column - 1, row) +
                                   at(column, row + 1) + at(column, row - 1)) /
                                  std::sqrt(8.0);
        }
    }
    return result;
}

// A stack whose focus curves have the standard deviation `width` in steps; `bytes` rounds its values to whole numbers.
inline ModelStack model_stack(int images, double width, bool bytes, unsigned seed) {
    std::mt19937 random(seed);
    const Grid<double> texture = texture_of(random);
    ModelStack stack{.images = {}, .z = {}, .height = Grid<double>(side, side)};
    const double amplitude = std::min(0.25 * (images - 1), 1.5);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            stack.height(column, row) =
                0.5 * (images - 1) + amplitude * std::sin(pi * column / side) * std::cos(pi * row / side);
        }
    }
    for (int image = 0; image < images; ++image) {
        Grid<float> values(side, side);
        for (std::size_t k = 0; k < values.values.size(); ++k) {
            const double defocus = (image - stack.height.values[k]) / width;
            const double value = 120 + 30 * texture.values[k] * std::exp(-0.5 * defocus * defocus);
            values.values[k] = static_cast<float>(bytes ? std::clamp(std::round(value), 0.0, 255.0) : value);
        }
        stack.images.push_back(std::move(values));
        stack.z.push_back(image);
    }
    return stack;
}

} // namespace vkfv::topography::test
