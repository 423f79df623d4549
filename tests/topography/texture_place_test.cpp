// On slopes, the heights of windows whose texture lies to one side are carried to its place: synthetic heights and
// images, and the closed form.
#include "topography/texture_place.hpp"

#include "topography/topography.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// A scene with texture in a single column: every window that reaches it has its centre there.
struct OneLine {
    static constexpr int side = 31, line = 15;
    static constexpr double slope_x = 0.2, slope_y = -0.1;
    Grid<float> image{side, side};
    Grid<double> truth{side, side};

    OneLine() {
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                image(column, row) = column == line ? 2.0f : 1.0f;
                truth(column, row) = slope_x * column + slope_y * row;
            }
        }
    }
};

TEST(TexturePlace, ARampIsCarriedByTheTexturesDistanceTimesItsSlope) {
    // The heights are a plane, so all of its slope counts; the line lies d columns from a window's middle, and the
    // vertical second difference of a vertical line is nothing.
    const OneLine scene;
    Grid<double> height = scene.truth;
    place_by_texture(height, {scene.image}, FocusMeasure::modified_laplacian, FocusWindow(5, WindowShape::box));
    for (const int d : {-1, 0, 1}) { // the line and the columns beside it: their windows hold all of it
        const int column = OneLine::line + d, row = 15;
        EXPECT_NEAR(height(column, row), scene.truth(column, row) + OneLine::slope_x * d, 1e-9);
    }
    EXPECT_EQ(height(5, 15), scene.truth(5, 15)); // no texture within its window
}

TEST(TexturePlace, EveryMeasureKnowsWhereItsTextureIs) {
    const OneLine scene;
    for (const auto& name : focus_measure_names()) {
        SCOPED_TRACE(name);
        Grid<double> height = scene.truth;
        place_by_texture(height, {scene.image}, focus_measure_from_name(name), FocusWindow(11, WindowShape::gaussian));
        const int column = OneLine::line - 3;
        const double carried = height(column, 15) - scene.truth(column, 15);
        EXPECT_LT(carried, -0.5 * OneLine::slope_x * 3);
        EXPECT_GT(carried, -1.2 * OneLine::slope_x * 3);
    }
}

TEST(TexturePlace, NoiseWithoutASlopeCarriesNothing) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    constexpr int side = 60;
    Grid<float> image(side, side);
    Grid<double> white(side, side), height(side, side);
    for (std::size_t k = 0; k < image.values.size(); ++k) {
        image.values[k] = static_cast<float>(10 + normal(random));
        white.values[k] = normal(random);
    }
    // Neighbouring heights share a window, as measured ones do.
    const FocusWindow window(7, WindowShape::box);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            for (int j = -3; j <= 3; ++j) {
                for (int i = -3; i <= 3; ++i) {
                    height(column, row) += white((column + i + side) % side, (row + j + side) % side) / 7;
                }
            }
        }
    }
    Grid<double> placed = height;
    place_by_texture(placed, {image}, FocusMeasure::wavelet, window);
    double before = 0, moved = 0;
    for (std::size_t k = 0; k < height.values.size(); ++k) {
        before += height.values[k] * height.values[k];
        moved += std::pow(placed.values[k] - height.values[k], 2);
    }
    EXPECT_LT(moved, 0.01 * before);
}

TEST(TexturePlace, GapsStayAndFewHeightsHaveNoSlope) {
    const OneLine scene;
    Grid<double> height(OneLine::side, OneLine::side);
    for (double& value : height.values) {
        value = nothing;
    }
    for (int row = 0; row < OneLine::side; ++row) {
        height(16, row) = scene.truth(16, row);
        height(17, row) = scene.truth(17, row);
    }
    const Grid<double> before = height;
    place_by_texture(height, {scene.image}, FocusMeasure::modified_laplacian, FocusWindow(5, WindowShape::box));
    EXPECT_TRUE(std::isnan(height(3, 3)));
    EXPECT_EQ(height(16, 15), before(16, 15));
    Grid<double> other(4, 4);
    EXPECT_THROW(place_by_texture(other, {scene.image}, FocusMeasure::wavelet, FocusWindow(5, WindowShape::box)),
                 std::invalid_argument);
}

// The error on a tilted plane with texture of very unlike strength, in focus within a Gaussian along z.
double error_on_a_ramp(bool placed) {
    std::mt19937 random(2);
    std::normal_distribution<double> normal;
    constexpr int side = 64, images = 31;
    constexpr double slope = 0.2, width = 2;
    Grid<double> texture(side, side);
    for (double& value : texture.values) {
        value = normal(random);
    }
    std::vector<Grid<float>> stack;
    std::vector<double> z;
    for (int image = 0; image < images; ++image) {
        Grid<float> values(side, side);
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                const double off = (image - (9 + slope * column)) / width;
                values(column, row) = static_cast<float>(100 + 10 * texture(column, row) * std::exp(-0.5 * off * off));
            }
        }
        stack.push_back(std::move(values));
        z.push_back(image);
    }
    const Topography found = reconstruct(stack, z, 0, 0, 1, {.place_by_texture = placed});
    double sum = 0;
    int count = 0;
    for (int row = 8; row < side - 8; ++row) {
        for (int column = 8; column < side - 8; ++column) {
            const double off = found.height.height(column, row) - (9 + slope * column);
            EXPECT_TRUE(std::isfinite(off));
            sum += off * off;
            ++count;
        }
    }
    return std::sqrt(sum / count);
}

TEST(TexturePlace, HalvesTheErrorOnARamp) {
    EXPECT_LT(error_on_a_ramp(true), 0.5 * error_on_a_ramp(false));
}

} // namespace
} // namespace vkfv::topography
