// Brightness that changes with focus moves the maxima of focus curves by what their uncertainty says.
#include "topography/uncertainty/brightness_pull.hpp"

#include "topography/model_stack.hpp"
#include "topography/topography.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr int pulled_images = 33;
constexpr double pulled_height = 16, curve_deviation = 4; // steps

// The brightness of the upper half of the rows grows by this share from step to step, and that of the lower half falls.
double light_at(int row, int image, double growth) {
    return std::exp((row < test::side / 2 ? -growth : growth) * (image - pulled_height));
}

enum class Texture { follows_brightness, keeps_its_strength };

std::vector<Grid<float>> pulled_stack(double growth, Texture kind) {
    std::mt19937 random(1);
    const Grid<double> texture = test::texture_of(random);
    std::vector<Grid<float>> stack;
    for (int image = 0; image < pulled_images; ++image) {
        Grid<float>& values = stack.emplace_back(test::side, test::side);
        const double defocus = (image - pulled_height) / curve_deviation;
        for (int row = 0; row < test::side; ++row) {
            const double light = light_at(row, image, growth);
            const double strength = 0.1 * (kind == Texture::follows_brightness ? light : 1);
            for (int column = 0; column < test::side; ++column) {
                values(column, row) =
                    static_cast<float>(light + strength * texture(column, row) * std::exp(-0.5 * defocus * defocus));
            }
        }
    }
    return stack;
}

// Mean deviation of the heights of the upper half from the true height, and their uncertainty by brightness there, in
// steps.
struct Pulled {
    double deviation = 0, uncertainty = 0, whole_uncertainty = 0;
};

Pulled pulled_of(double growth, Texture kind, double smoothing) {
    std::vector<double> z;
    for (int k = 0; k < pulled_images; ++k) {
        z.push_back(k);
    }
    const auto found =
        reconstruct(pulled_stack(growth, kind), z, 0, 0, 1,
                    {.window_px = 9, .smoothing_steps = smoothing, .false_peak_rate = 1, .most_rival = 1});
    Pulled result;
    double points = 0;
    constexpr int margin = 18; // two windows from the middle, where halves meet, and from the edge
    for (int row = test::side / 2 + margin; row < test::side - margin / 2; ++row) {
        for (int column = margin / 2; column < test::side - margin / 2; ++column) {
            if (const double height = found.height.height(column, row); std::isfinite(height)) {
                result.deviation += height - pulled_height;
                result.uncertainty += found.brightness_pull.at(column, row);
                result.whole_uncertainty += found.height_uncertainty(column, row);
                points += 1;
            }
        }
    }
    EXPECT_GT(points, 400);
    result.deviation /= points;
    result.uncertainty /= points;
    result.whole_uncertainty /= points;
    return result;
}

// The curve exp(-(z - h)^2 / (2 s^2) - g z) has its maximum at h - s^2 g. The average of the images adds its variance
// to s^2, also where texture follows: 0.45 steps here.
TEST(BrightnessPull, IsHowFarTheMaximumMovesIfTextureDoesNotFollow) {
    constexpr double growth = 0.05;
    for (const double smoothing : {0.0, 3.0}) {
        const double by_average = growth * smoothing * smoothing;
        const double moved = growth * curve_deviation * curve_deviation + by_average;
        const auto constant = pulled_of(growth, Texture::keeps_its_strength, smoothing);
        EXPECT_NEAR(constant.deviation, -moved, 0.05 * moved) << smoothing;
        // The width of the curves is found from the stack, to a tenth.
        EXPECT_NEAR(constant.uncertainty, moved, 0.25 * moved) << smoothing;
        EXPECT_GE(constant.whole_uncertainty, constant.uncertainty) << smoothing;
        // Heights of texture that follows move by the average alone, which the stack does not show: they have the same
        // uncertainty.
        const auto following = pulled_of(growth, Texture::follows_brightness, smoothing);
        EXPECT_NEAR(following.deviation, -by_average, 0.05 * moved) << smoothing;
        EXPECT_NEAR(following.uncertainty, moved, 0.25 * moved) << smoothing;
    }
}

BrightnessPull pull_of_blocks(const auto& brightness_at) {
    constexpr int blocks = 10, window = 5, images = 21;
    BrightnessOfBlocks stack(blocks * window, blocks * window, window);
    for (int image = 0; image < images; ++image) {
        Grid<float> values(blocks * window, blocks * window);
        for (int row = 0; row < values.rows; ++row) {
            for (int column = 0; column < values.columns; ++column) {
                values(column, row) = static_cast<float>(brightness_at(column / window, row / window, image));
            }
        }
        stack.add({values});
    }
    return stack.pull(Grid<double>(blocks * window, blocks * window, 10.0), 3, 2);
}

TEST(BrightnessPull, IsNoneOfALampThatFlickersNorOfSingleWindows) {
    const auto flicker = pull_of_blocks([](int, int, int image) { return 1 + 0.3 * std::sin(0.3 * image); });
    EXPECT_LT(flicker.at(25, 25), 1e-5);
    // Every block changes for itself, by 0.05 a step of standard deviation: 3^2 * 2 * 0.05 would be its height's shift.
    std::mt19937 random(2);
    std::normal_distribution<double> normal(0, 0.05);
    Grid<double> slopes(10, 10);
    for (double& slope : slopes.values) {
        slope = normal(random);
    }
    const auto single =
        pull_of_blocks([&](int column, int row, int image) { return std::exp(slopes(column, row) * (image - 10)); });
    double square = 0;
    for (const double pull : single.blocks.values) {
        square += pull * pull / static_cast<double>(single.blocks.values.size());
    }
    // The larger of two means of six products of variance 1 has the expectation 0.27, or 0 if it is negative.
    EXPECT_LT(std::sqrt(square), 0.65 * 9 * 2 * 0.05);
    // The wrong twin is a change that all blocks of a half have in common, of the same size.
    const auto common =
        pull_of_blocks([](int column, int, int image) { return std::exp((column < 5 ? -0.05 : 0.05) * (image - 10)); });
    EXPECT_NEAR(common.at(10, 25), 9 * 2 * 0.05, 0.02);
    EXPECT_EQ(BrightnessPull{}.at(3, 3), 0);
}

TEST(BrightnessPull, IsUnknownWithoutLightHeightsOrImagesAround) {
    BrightnessOfBlocks stack(20, 20, 5);
    for (int image = 0; image < 5; ++image) {
        stack.add({Grid<float>(20, 20, 0.0f)});
    }
    const auto pull_at = [](const BrightnessOfBlocks& of, double height, double width) {
        return of.pull(Grid<double>(20, 20, height), width, 1).at(10, 17);
    };
    EXPECT_EQ(pull_at(stack, 2, 1), 0) << "dark";
    BrightnessOfBlocks lit(20, 20, 5);
    for (int image = 0; image < 5; ++image) {
        Grid<float> values(20, 20, 1.0f);
        for (int row = 0; row < 10; ++row) {
            std::fill_n(values.values.begin() + 20 * row, 20, std::exp(0.2f * static_cast<float>(image)));
        }
        lit.add({values});
    }
    EXPECT_GT(pull_at(lit, 2, 1), 0.02);
    EXPECT_EQ(pull_at(lit, 0, 1), 0) << "at an end";
    EXPECT_EQ(pull_at(lit, std::nan(""), 1), 0) << "not measured";
    EXPECT_EQ(pull_at(lit, 2, 0), 0) << "curves without a form";
    EXPECT_EQ(pull_at(lit, 2, 4), 0) << "curves wider than the scan";
}

} // namespace
} // namespace vkfv::topography
