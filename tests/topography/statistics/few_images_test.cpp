// Stacks of few images, of curves as narrow as their steps, of 8 bits, and in random order (model_stack.hpp) are
// measured where, and only where, they have a maximum.
#include "topography/focus_probes.hpp"
#include "topography/model_stack.hpp"
#include "topography/topography.hpp"

#include "core/mathematics/units.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

using test::model_stack;
using test::ModelStack;
using test::side;
using test::texture_of;

double measured_share(const Topography& topography) {
    return static_cast<double>(std::ranges::count(topography.state.values, PointState::measured)) / (side * side);
}

// The root mean square of the measured heights less the true ones, in steps of the scan.
double deviation_of(const Topography& topography, const ModelStack& stack) {
    double sum = 0, measured = 0;
    for (std::size_t k = 0; k < stack.height.values.size(); ++k) {
        if (topography.state.values[k] == PointState::measured) {
            sum += std::pow(topography.height.height.values[k] - stack.height.values[k], 2);
            ++measured;
        }
    }
    return std::sqrt(sum / measured);
}

TEST(FewImages, AreMeasuredByDefault) {
    for (const int images : {7, 9, 15, 31}) {
        for (const double width : {0.8, 1.0, 2.0, 5.0}) {
            for (const bool bytes : {false, true}) {
                SCOPED_TRACE(testing::Message() << images << " images, width " << width << (bytes ? ", 8 bits" : ""));
                const ModelStack stack = model_stack(images, width, bytes, 1);
                const Topography topography = reconstruct(stack.images, stack.z, 0, 0, 1, {});
                double sum = 0;
                int measured = 0;
                for (std::size_t k = 0; k < stack.height.values.size(); ++k) {
                    const double off = topography.height.height.values[k] - stack.height.values[k];
                    if (std::isfinite(off)) {
                        sum += off * off;
                        ++measured;
                    }
                }
                EXPECT_GE(measured, 0.98 * side * side);
                EXPECT_LE(std::sqrt(sum / measured), images == 7           ? 0.15
                                                     : bytes && width == 5 ? 0.07
                                                                           : 0.06); // rounding moves flat curves
            }
        }
    }
}

TEST(FewImages, InRandomOrderAreNotMeasured) {
    for (const auto& [images, width] : {std::pair{15, 1.0}, {15, 5.0}, {31, 1.0}, {31, 5.0}}) {
        SCOPED_TRACE(testing::Message() << images << " images, width " << width);
        ModelStack stack = model_stack(images, width, true, 2);
        std::mt19937 random(3);
        constexpr int orders = 20;
        double share = 0;
        for (int k = 0; k < orders; ++k) {
            std::ranges::shuffle(stack.images, random);
            const Topography topography = reconstruct(stack.images, stack.z, 0, 0, 1, {});
            share += measured_share(topography) / orders;
        }
        EXPECT_LE(share, 0.01);
    }
}

// Steps of the scan may be as coarse as the depth of field or coarser: texture is sharp in one image alone then, and
// differs from noise by its blurred neighbours or, where nothing is left in these, by the surface that it lies on.
// A height is then at least that of the nearest image, whose deviation is uniform over a step. Where the texture is
// between two images and blurred in both, points may be left out.
TEST(FewImages, WithTextureSharpInOneImageAloneAreMeasured) {
    struct Case {
        double blur;  // pixels a step
        double least; // share of the points
    };
    const double of_nearest = 1 / std::sqrt(12.0);
    for (const Case& one : {Case{0.7, 0.98}, {1, 0.98}, {1.5, 0.98}, {2, 0.98}, {3, 0.9}, {4, 0.75}}) {
        SCOPED_TRACE(testing::Message() << "blur of " << one.blur << " pixels a step");
        const ModelStack stack = test::blurred_slope(9, 2, 6, one.blur, 0.005, 5);
        const Topography topography = reconstruct(stack.images, stack.z, 0, 0, 1, {});
        EXPECT_GE(measured_share(topography), one.least);
        EXPECT_LE(deviation_of(topography, stack), of_nearest);
    }
}

// The wrong twin: noise as strong as that texture and in one image alone, as all places see it.
TEST(FewImages, WithNoiseStrongInOneImageAloneAreNotMeasured) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        ModelStack stack = model_stack(9, 1, true, seed);
        for (std::size_t image = 0; image < stack.images.size(); ++image) {
            const double contrast = image == 4 ? 0.35 * 0.4 : 0.005; // blurred by 0.7 pixels, white texture keeps 0.4
            for (float& value : stack.images[image].values) {
                const double bright = 120 * (1 + contrast * normal(random));
                value = static_cast<float>(std::clamp(std::round(bright), 0.0, 255.0));
            }
        }
        EXPECT_LE(measured_share(reconstruct(stack.images, stack.z, 0, 0, 1, {})), 0.01);
    }
}

TEST(FewImages, TellWhatPassesByChance) {
    // A share of 0.03 to 0.1 of stacks of seven values in random order is unimodal, depending on their form.
    const ModelStack stack = model_stack(7, 1, false, 4);
    const Topography topography = reconstruct(stack.images, stack.z, 0, 0, 1, {});
    EXPECT_EQ(topography.stack.limit.least.unimodality, most_unimodality_asked);
    EXPECT_GT(topography.stack.limit.rate, 0.01);
    EXPECT_LT(topography.stack.limit.rate, 0.15);
    const Topography unlimited = reconstruct(stack.images, stack.z, 0, 0, 1, {.false_peak_rate = 1});
    EXPECT_EQ(unlimited.stack.limit.least.unimodality, 0);
}

// Maxima 3 steps apart, which the average along z makes one, stand on texture of Gaussian contrast around both heights.
TEST(FocusCurve, TwoMaximaThatAveragesMakeOneAreNotMeasured) {
    constexpr int images = 41;
    std::mt19937 random(8);
    const Grid<double> texture = texture_of(random);
    const auto measured = [&](double apart, double most_rival) {
        StackEvaluator evaluator({.smoothing_steps = 2, .most_rival = most_rival});
        for (int image = 0; image < images; ++image) {
            const auto contrast = [&](double height) { return std::exp(-0.5 * (image - height) * (image - height)); };
            const double here = contrast(20 - apart / 2) + contrast(20 + apart / 2);
            Grid<float> values(side, side);
            for (std::size_t k = 0; k < values.values.size(); ++k) {
                values.values[k] = static_cast<float>(120 + 10 * texture.values[k] * here);
            }
            evaluator.add(values, image);
        }
        const auto state = evaluator.finish(0, 0, 1).state;
        return std::ranges::count(state.values, PointState::measured);
    };
    EXPECT_EQ(measured(0, 0.15), side * side);
    EXPECT_EQ(measured(3.4, 0.15), 0);
    EXPECT_EQ(measured(3.4, 1), side * side);
}

// The texture's pixels are, every few at random, in focus at one of two heights 12 steps apart, in noise that hides the
// second maximum of a point's own curve. The other case has these two heights as a step of the specimen's.
TEST(FocusCurve, TwoMaximaThatNoiseHidesAreNotMeasured) {
    constexpr int wide_side = 128, images = 31, cell = 4;
    const auto measured = [&](bool step, double noise, double most_rival) {
        std::mt19937 random(9);
        std::normal_distribution<double> normal;
        Grid<double> texture(wide_side, wide_side), height(wide_side, wide_side);
        std::vector<int> cells(static_cast<std::size_t>(wide_side));
        for (int row = 0; row < wide_side; ++row) {
            for (int column = 0; column < wide_side; ++column) {
                if (row % cell == 0 && column % cell == 0) {
                    std::fill_n(cells.begin() + column, cell, static_cast<int>(random() % 2));
                }
                const bool upper = step ? column >= wide_side / 2 : cells[static_cast<std::size_t>(column)] == 1;
                texture(column, row) = normal(random);
                height(column, row) = 0.5 * (images - 1) + (upper ? 6 : -6);
            }
        }
        StackEvaluator evaluator({.smoothing_steps = 2, .false_peak_rate = 0.05, .most_rival = most_rival});
        for (int image = 0; image < images; ++image) {
            Grid<float> values(wide_side, wide_side);
            for (std::size_t k = 0; k < values.values.size(); ++k) {
                const double defocus = (image - height.values[k]) / 2;
                values.values[k] = static_cast<float>(
                    120 + 10 * texture.values[k] * std::exp(-0.5 * defocus * defocus) + noise * normal(random));
            }
            evaluator.add(values, image);
        }
        const auto state = evaluator.finish(0, 0, 1).state;
        return static_cast<double>(std::ranges::count(state.values, PointState::measured)) / (wide_side * wide_side);
    };
    EXPECT_GT(measured(false, 5, 0.999), 0.5); // the wrong twin: limits of single points alone
    EXPECT_LT(measured(false, 5, 0.15), 0.01);
    EXPECT_GT(measured(true, 8, 0.15), 0.6);
}

TEST(FocusProbes, TellTheWidthOfFocusCurves) {
    for (const auto& [images, width] : {std::pair{15, 1.0}, {15, 3.0}, {31, 2.0}, {31, 5.0}, {61, 1.0}, {61, 5.0}}) {
        const ModelStack stack = model_stack(images, width, false, 5);
        FocusProbes probes(side, side, FocusMeasure::wavelet, FocusWindow(7, WindowShape::box));
        for (const auto& image : stack.images) {
            probes.add({image});
        }
        // Widths are tried in steps of a twentieth; the window mixes heights.
        EXPECT_NEAR(probes.curve_width(), width, 0.08 * width) << images << " images";
    }
}

// Averages of fewer images leave more noise, which a focus measure takes for texture: at the ends of a scan that must
// not pass for a second maximum.
// Images made by a program may have texture in one image and one value in all others, here at two levels with a gap
// between them. Nothing of the texture persists there, and nothing is alike: 0, and not 0 over 0.
TEST(FocusProbes, FindTextureBetweenImagesOfOneValueAlikeByNothing) {
    FocusProbes probes(side, side, FocusMeasure::wavelet, FocusWindow(7, WindowShape::box));
    constexpr int half_gap = 6;
    const ModelStack sharp = test::blurred_slope(1, 0, 0, 0, 0, 5);
    for (int image = 0; image < 9; ++image) {
        Grid<float> values(side, side, 120);
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                if ((image == 3 && column < side / 2 - half_gap) || (image == 5 && column >= side / 2 + half_gap)) {
                    values(column, row) = sharp.images[0](column, row);
                }
            }
        }
        probes.add({values});
    }
    const auto strong = probes.persistence_of_strong_texture({1, 0.5}, false);
    ASSERT_TRUE(strong.has_value());
    EXPECT_NEAR(strong->share, 0, 1e-9);
    EXPECT_NEAR(strong->correlation, 0, 1e-9);
}

TEST(FocusProbes, FindNoSecondMaximumInWeakTextureAndNoise) {
    constexpr int wide_side = 128, images = 41, window = 41;
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    Grid<double> texture(wide_side, wide_side);
    std::ranges::generate(texture.values, [&] { return normal(random); });
    FocusProbes probes(wide_side, wide_side, FocusMeasure::modified_laplacian, FocusWindow(window, WindowShape::box));
    for (int image = 0; image < images; ++image) {
        const double defocus = (image - 20) / 3.0;
        Grid<float> values(wide_side, wide_side);
        for (std::size_t k = 0; k < values.values.size(); ++k) {
            values.values[k] = static_cast<float>(120 + 3 * texture.values[k] * std::exp(-0.5 * defocus * defocus) +
                                                  8 * normal(random));
        }
        probes.add({values});
    }
    EXPECT_LT(probes.share_with_rival(axial_weights(2.4), 0.15), 0.1);
}

TEST(FocusProbes, TellTheNoiseOfImages) {
    // The noise has the variance 4 + 0.1 value, on a stack whose texture comes into focus.
    ModelStack stack = model_stack(61, 2, false, 6);
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    FocusProbes probes(side, side, FocusMeasure::wavelet, FocusWindow(7, WindowShape::box));
    for (auto& image : stack.images) {
        for (float& value : image.values) {
            value += static_cast<float>(std::sqrt(4 + 0.1 * value) * normal(random));
        }
        probes.add({image});
    }
    EXPECT_NEAR(probes.noise().variance(120), 16, 2.4);
}

TEST(FocusCurve, UnimodalityAndTheRivalAreTheirDefinitions) {
    const auto shape_of = [](const std::vector<double>& values) {
        auto shape = focus::f64::empty_curve();
        for (std::size_t k = 0; k < values.size(); ++k) {
            shape = focus::f64::follow_shape(shape, values[k], static_cast<int>(k));
        }
        return shape;
    };
    EXPECT_EQ(focus::f64::unimodality(shape_of({1, 2, 5, 5, 3, 1})), 1);
    EXPECT_EQ(shape_of({1, 2, 5, 5, 3, 1}).rival, 0);
    // The rises and falls are 4 + 3 + 2 + 3; the largest maximum accounts for 4 + 4 of these.
    EXPECT_EQ(focus::f64::unimodality(shape_of({1, 5, 2, 4, 1})), 8.0 / 12);
    EXPECT_EQ(shape_of({1, 5, 2, 4, 1}).rival, 2);
    EXPECT_EQ(shape_of({1, 4, 2, 5, 1}).rival, 2); // the lesser one first
    EXPECT_EQ(shape_of({5, 1, 3, 0, 4}).rival, 4); // by the deepest valley
    EXPECT_EQ(focus::f64::unimodality(shape_of({3, 3, 3})), 0);
}

TEST(FocusCurve, TheOrderShownIsItsDefinition) {
    const std::vector<double> single = {3, 7, 2, 9, 4, 5, 1}, averaged = {2, 4, 6, 7, 5, 4, 3};
    auto curve = focus::f64::empty_curve();
    focus::f64::SingleRecord record{};
    for (std::size_t k = 0; k < single.size(); ++k) {
        curve = focus::f64::follow_shape(curve, averaged[k], static_cast<int>(k));
        record = focus::f64::follow_single(record, single[k], static_cast<int>(k));
    }
    const auto variance = [](const std::vector<double>& values) {
        const double count = static_cast<double>(values.size());
        const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
        return std::accumulate(values.begin(), values.end(), 0.0,
                               [&](double sum, double value) { return sum + (value - mean) * (value - mean); }) /
               count;
    };
    // The squares of steps one to three images apart are 16 + 25 + 49 + 25 + 1 + 16, 1 + 4 + 4 + 16 + 9, 36 + 9 + 9 +
    // 64.
    const double twice = 2 * 7 * variance(single);
    const double correlation = (6.0 / 7 - 132 / twice) + 0.8 * (5.0 / 7 - 34 / twice) + 0.5 * (4.0 / 7 - 118 / twice);
    const double unimodal = (2 * 7 - 2 - 3) / 9.0;
    EXPECT_NEAR(focus::f64::order_shown(curve, record, 7),
                unimodal * std::sqrt(variance(averaged) / variance(single)) * std::exp(correlation), 1e-14);
    EXPECT_EQ(record.rival, 5); // from 7 to 2, and up again beyond it
    EXPECT_NEAR(focus::f64::single_rise(record, 7), 9 - 31.0 / 7, 1e-14);
    EXPECT_EQ(focus::f64::order_shown(curve, focus::f64::SingleRecord{}, 7), 0); // nothing varies
}

} // namespace
} // namespace vkfv::topography
