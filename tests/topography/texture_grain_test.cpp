// The reach of grains is found of texture whose correlation is known.
#include "topography/uncertainty/texture_grain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace vkfv::topography {
namespace {

// A texture of means over `width` x `width` independent values about 1000.
Grid<float> texture(int side, int width) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal(1000, 10);
    Grid<double> white(side + width - 1, side + width - 1);
    std::ranges::generate(white.values, [&] { return normal(random); });
    Grid<float> image(side, side);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            double sum = 0;
            for (int y = 0; y < width; ++y) {
                for (int x = 0; x < width; ++x) {
                    sum += white(column + x, row + y) / (width * width);
                }
            }
            image(column, row) = static_cast<float>(sum);
        }
    }
    return image;
}

// Squares of normal values have the square of their correlation. 300 x 300 pixels of at most 3 x 3 grains tell it to
// 0.01; the mean of the window, which the measure takes off, is of 41 x 41 pixels.
TEST(TextureGrain, IsTheSquareOfTheTexturesCorrelation) {
    const FocusWindow window(41, WindowShape::box);
    for (const int width : {1, 3}) {
        const auto found = grain_correlation({texture(300, width)}, FocusMeasure::standard_deviation, window);
        ASSERT_EQ(found.columns, 33);
        for (int y = -3; y <= 3; ++y) {
            for (int x = -3; x <= 3; ++x) {
                const auto along = [&](int d) { return std::max(0.0, 1 - std::abs(d) / static_cast<double>(width)); };
                EXPECT_NEAR(found(16 + x, 16 + y), std::pow(along(x) * along(y), 2), 0.04)
                    << width << " " << x << " " << y;
            }
        }
    }
}

TEST(TextureGrain, IsNoneWithoutTexture) {
    const auto found = grain_correlation({Grid<float>(30, 30, 5.0f)}, FocusMeasure::modified_laplacian,
                                         FocusWindow(7, WindowShape::box));
    EXPECT_EQ(found.columns, 13);
    for (int y = 0; y < 13; ++y) {
        for (int x = 0; x < 13; ++x) {
            EXPECT_EQ(found(x, y), x == 6 && y == 6 ? 1 : 0);
        }
    }
}

} // namespace
} // namespace vkfv::topography
