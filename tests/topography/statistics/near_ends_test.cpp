// Specimens in focus near an end of the scan are measured without bias: their texture is blurred by Gaussians that
// widen with the distance from focus.
#include "topography/focus_probes.hpp"
#include "topography/model_stack.hpp"
#include "topography/topography.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

using test::blurred;
using test::side;

// A flat specimen at `place` in steps of the scan, blurred by `blur` pixels a step.
std::vector<Grid<float>> flat_at(double place, double blur, unsigned seed, int images = 41) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Grid<double> texture(side, side);
    std::ranges::generate(texture.values, [&] { return normal(random); });
    std::vector<Grid<float>> stack;
    for (int image = 0; image < images; ++image) {
        constexpr double flat = 12; // pixels; nothing is left of texture that is blurred more
        const Grid<double> seen = blurred(texture, std::min(flat, std::hypot(0.9, blur * (image - place))));
        Grid<float>& values = stack.emplace_back(side, side);
        for (std::size_t k = 0; k < values.values.size(); ++k) {
            values.values[k] = static_cast<float>(1000 * (1 + 0.4 * seen.values[k] + 0.005 * normal(random)));
        }
    }
    return stack;
}

struct Found {
    double measured = 0; // share
    double bias = 0;     // steps
    double beyond = 0;   // share of the measured points that are more than three uncertainties away
    double width = 0;
};

Topography evaluated(const std::vector<Grid<float>>& stack, std::optional<double> smoothing = {},
                     FocusMeasure measure = FocusMeasure::wavelet) {
    std::vector<double> z(stack.size());
    std::iota(z.begin(), z.end(), 0.0);
    return reconstruct(stack, z, 0, 0, 1, {.focus_measure = measure, .smoothing_steps = smoothing});
}

// The figures of the columns from first to end.
Found found_in(const Topography& topography, double place, int first, int end) {
    Found found{.width = topography.stack.curve_width_steps};
    int measured = 0, beyond = 0;
    for (int row = 0; row < side; ++row) {
        for (int column = first; column < end; ++column) {
            if (topography.state(column, row) == PointState::measured) {
                const double off = topography.height.height(column, row) - place;
                ++measured;
                found.bias += off;
                beyond += std::abs(off) > 3 * topography.height_uncertainty(column, row) ? 1 : 0;
            }
        }
    }
    found.measured = measured / static_cast<double>(side * (end - first));
    found.bias /= std::max(1, measured);
    found.beyond = beyond / static_cast<double>(std::max(1, measured));
    return found;
}

Found found_at(double place, double blur, unsigned seed, int images = 41, std::optional<double> smoothing = {},
               FocusMeasure measure = FocusMeasure::wavelet) {
    return found_in(evaluated(flat_at(place, blur, seed, images), smoothing, measure), place, 0, side);
}

void expect_measured(int images, const std::vector<double>& distances, const std::vector<double>& blurs,
                     FocusMeasure measure = FocusMeasure::wavelet) {
    for (const double blur : blurs) {
        double beyond = 0;
        int cases = 0;
        for (const double from_end : distances) {
            for (const bool last : {false, true}) {
                const double place = last ? images - 1 - from_end : from_end;
                const Found found = found_at(place, blur, 1, images, {}, measure);
                SCOPED_TRACE(testing::Message()
                             << "image " << place << " of " << images << ", curves " << found.width << " steps wide");
                EXPECT_GE(found.measured, 0.95);
                EXPECT_NEAR(found.bias, 0, 0.1);
                beyond += found.beyond;
                ++cases;
            }
        }
        EXPECT_LE(beyond / cases, 0.015) << "blur " << blur;
    }
}

TEST(NearTheEnds, WhatIsInTheScanIsMeasured) {
    expect_measured(41, {3.0, 4.0, 6.0}, {0.5, 0.35, 0.25, 0.19});
}

TEST(NearTheEnds, WhatIsInAShortOrLongScanIsMeasured) {
    expect_measured(31, {3.0, 6.0}, {0.5, 0.25});
    expect_measured(101, {4.0}, {0.35, 0.19});
}

TEST(NearTheEnds, WhatIsInTheScanIsMeasuredByTheMeasuresForNoise) {
    for (const FocusMeasure measure : {where_noise_counts, where_noise_is_low}) {
        SCOPED_TRACE(name_of(measure));
        expect_measured(41, {3.0, 6.0}, {0.35, 0.19}, measure);
    }
}

// A part of the field is in focus over more images than the other, as a window upon a slope is, and the stack's width
// is that of neither part.
TEST(NearTheEnds, PartsOfDifferentDepthsOfFocusAreMeasuredEachByItsOwnWidth) {
    constexpr int images = 61, margin = 8; // pixels whose windows see both parts
    for (const double from_end : {3.0, 4.0, 6.0}) {
        for (const bool last : {false, true}) {
            const double place = last ? images - 1 - from_end : from_end;
            auto stack = flat_at(place, 0.42, 3, images);
            const auto wide = flat_at(place, 0.19, 4, images);
            for (std::size_t image = 0; image < stack.size(); ++image) {
                for (int row = 0; row < side; ++row) {
                    for (int column = side / 2; column < side; ++column) {
                        stack[image](column, row) = wide[image](column, row);
                    }
                }
            }
            const Topography topography = evaluated(stack);
            for (const auto& [first, end] :
                 {std::pair{margin, side / 2 - margin}, {side / 2 + margin, side - margin}}) {
                const Found found = found_in(topography, place, first, end);
                SCOPED_TRACE(testing::Message() << "image " << place << ", columns from " << first << ", all curves "
                                                << found.width << " steps wide");
                EXPECT_GE(found.measured, 0.95);
                EXPECT_NEAR(found.bias, 0, 0.1);
                EXPECT_LE(found.beyond, 0.015);
            }
        }
    }
}

TEST(NearTheEnds, AnAverageAsWideAsTheCurvesAllowLosesIt) {
    // The wrong twin is the average that suits the curves' width in the middle of the scan.
    const Found found = found_at(3, 0.19, 1, 41, most_smoothing_of_width * 2.8);
    EXPECT_GT(found.width, 2);
    EXPECT_LT(found.measured, 0.5);
}

TEST(NearTheEnds, CurvesInTheMiddleAreAveragedAsBefore) {
    FocusProbes probes(side, side, FocusMeasure::wavelet, FocusWindow(7, WindowShape::box));
    for (const auto& image : flat_at(20, 0.19, 2)) {
        probes.add({image});
    }
    EXPECT_EQ(probes.suitable_smoothing(), suitable_smoothing(probes.curve_width(), 41));
}

} // namespace
} // namespace vkfv::topography
