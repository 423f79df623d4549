// Stacks made without optics, whose contrast in every pixel is a Gaussian along z around its height.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/mathematics/units.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
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

// The convolution with a Gaussian of standard deviation sigma in pixels, by which the image continues itself.
inline Grid<double> blurred(const Grid<double>& image, double sigma) {
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    std::vector<double> weights;
    for (int d = -radius; d <= radius; ++d) {
        weights.push_back(std::exp(-0.5 * d * d / (sigma * sigma)));
    }
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    Grid<double> along_x(side, side), both(side, side);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            for (int d = -radius; d <= radius; ++d) {
                along_x(column, row) +=
                    weights[static_cast<std::size_t>(d + radius)] / total * image((column + d + side) % side, row);
            }
        }
    }
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            for (int d = -radius; d <= radius; ++d) {
                both(column, row) +=
                    weights[static_cast<std::size_t>(d + radius)] / total * along_x(column, (row + d + side) % side);
            }
        }
    }
    return both;
}

// A plane whose height rises along x from `first` to `last` in steps of the scan. Its white texture is blurred by
// Gaussians that widen by `blur` pixels a step, and noise of `noise` of the brightness is added. 8 bits.
inline ModelStack blurred_slope(int images, double first, double last, double blur, double noise, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Grid<double> texture(side, side);
    std::ranges::generate(texture.values, [&] { return normal(random); });
    constexpr double sharp = 0.7, flat = 20; // pixels; nothing is left of texture that is blurred more
    constexpr double parts = 8;              // of a step: the defocus at which blurred textures are made
    std::map<int, Grid<double>> seen;        // by defocus in these parts
    ModelStack stack{.images = {}, .z = {}, .height = Grid<double>(side, side)};
    for (int image = 0; image < images; ++image) {
        Grid<float> values(side, side);
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                const double height = std::lerp(first, last, (column + 0.5) / side);
                const int defocus = static_cast<int>(std::lround(std::abs(image - height) * parts));
                if (!seen.contains(defocus)) {
                    seen[defocus] = blurred(texture, std::min(flat, std::hypot(sharp, blur * defocus / parts)));
                }
                const double value = 120 * (1 + 0.35 * seen[defocus](column, row) + noise * normal(random));
                values(column, row) = static_cast<float>(std::clamp(std::round(value), 0.0, 255.0));
                stack.height(column, row) = height;
            }
        }
        stack.images.push_back(std::move(values));
        stack.z.push_back(image);
    }
    return stack;
}

} // namespace vkfv::topography::test
