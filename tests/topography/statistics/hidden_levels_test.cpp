// Levels of height that a window has at once are found of textures at two heights, and not of slopes and single levels.
#include "topography/hidden_levels.hpp"

#include "topography/focus_probes.hpp"
#include "topography/model_stack.hpp"
#include "topography/topography.hpp"
#include "topography/uncertainty/height_uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr int side = test::side, images = 41, window = 7;
constexpr double width = 3; // images: standard deviation of a texture's amplitude along z

// A texture that fades as a Gaussian along z around heights of its own, in steps.
struct Layer {
    std::function<double(int, int)> height;
    double contrast;
};

std::vector<Grid<float>> stack_of(const std::vector<Layer>& layers, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.01);
    std::vector<Grid<double>> textures;
    for (std::size_t k = 0; k < layers.size(); ++k) {
        textures.push_back(test::texture_of(random));
    }
    std::vector<Grid<float>> stack;
    for (int image = 0; image < images; ++image) {
        Grid<float>& values = stack.emplace_back(side, side);
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                double value = 1 + noise(random);
                for (std::size_t k = 0; k < layers.size(); ++k) {
                    const double defocus = (image - layers[k].height(column, row)) / width;
                    value += layers[k].contrast * textures[k](column, row) * std::exp(-0.5 * defocus * defocus);
                }
                values(column, row) = static_cast<float>(value);
            }
        }
    }
    return stack;
}

std::vector<Layer> two_levels(double apart) {
    return {{[apart](int, int) { return 20 + apart / 2; }, 0.15}, {[apart](int, int) { return 20 - apart / 2; }, 0.15}};
}

std::vector<Layer> slope(double rise) {
    return {{[rise](int column, int) { return 20 + rise * (column - side / 2); }, 0.2}};
}

std::vector<LevelsAtPlace> places_of(const std::vector<Grid<float>>& stack, double smoothing) {
    FocusProbes probes(side, side, FocusMeasure::wavelet, FocusWindow(window, WindowShape::box));
    for (const auto& image : stack) {
        probes.add({image});
    }
    return probes.levels(axial_weights(smoothing));
}

double mean_variance(const std::vector<LevelsAtPlace>& places) {
    double sum = 0;
    for (const LevelsAtPlace& place : places) {
        sum += place.variance / static_cast<double>(places.size());
    }
    return sum;
}

TEST(HiddenLevels, AreAsFarAsTheTexturesAre) {
    for (const double smoothing : {0.0, 1.5}) {
        for (const double apart : {4.0, 6.0, 8.0}) {
            const auto places = places_of(stack_of(two_levels(apart), 1), smoothing);
            ASSERT_GT(places.size(), 150u);
            // The tails, a fifth of the curve, are left out, which takes off from levels nearby. Levels far apart both
            // have half the distance from the maximum, or one of them the whole.
            const double distance = std::sqrt(mean_variance(places)) / (apart / 2);
            EXPECT_GT(distance, 0.7) << apart << " " << smoothing;
            EXPECT_LT(distance, 1.2) << apart << " " << smoothing;
        }
        // The wrong twin has as much texture, at one level.
        EXPECT_NEAR(mean_variance(places_of(stack_of(slope(0), 1), smoothing)), 0, 0.1) << smoothing;
    }
}

TEST(HiddenLevels, ASlopeHasNone) {
    constexpr double rise = 1; // steps a pixel: 2 steps in the window's standard deviation
    const auto places = places_of(stack_of(slope(rise), 2), 1.5);
    Grid<double> height(side, side);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            height(column, row) = rise * column;
        }
    }
    const int radius = window / 2;
    EXPECT_EQ(HiddenLevels(places, height, 1, radius).variance(side / 2, side / 2), 0);
    EXPECT_LT(HiddenLevels(places, height, 1, radius).mean_deviation(), 0.8);
    // The wrong twin is a level map, whose slope is not taken off.
    EXPECT_GT(HiddenLevels(places, Grid<double>(side, side), 1, radius).variance(side / 2, side / 2), 1);
    EXPECT_EQ(HiddenLevels({}, height, 1, radius).variance(3, 3), 0);
}

// The height of a window with two levels is that of neither, or of one of them.
TEST(HiddenLevels, AreInTheUncertainty) {
    std::vector<double> z;
    for (int k = 0; k < images; ++k) {
        z.push_back(k);
    }
    for (const double apart : {4.0, 5.0}) {
        const auto found =
            reconstruct(stack_of(two_levels(apart), 3), z, 0, 0, 1,
                        {.window_px = window, .smoothing_steps = 1.5, .false_peak_rate = 1, .most_rival = 1});
        const auto of_neighbours =
            height_uncertainty(found.height.height, found.height_noise, window, WindowShape::box);
        double beyond = 0, twin = 0, points = 0;
        for (std::size_t k = 0; k < of_neighbours.values.size(); ++k) {
            const double height = found.height.height.values[k];
            if (std::isfinite(height)) {
                const double off = std::abs(height - 20 - apart / 2);
                beyond += off > 3 * found.height_uncertainty.values[k] ? 1 : 0;
                twin += off > 3 * of_neighbours.values[k] ? 1 : 0;
                points += 1;
            }
        }
        EXPECT_LE(beyond / points, 0.02) << apart;
        EXPECT_GT(twin / points, 0.1) << apart;
        EXPECT_GT(found.stack.hidden_relief, apart / 4) << apart;
    }
}

} // namespace
} // namespace vkfv::topography
