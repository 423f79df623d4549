// Flat specimens that are in focus near an end of the scan: texture blurred by Gaussians that widen with the distance
// from focus.
#include "topography/focus_probes.hpp"
#include "topography/topography.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr int side = 72;
constexpr int images = 41;

Grid<double> blurred(const Grid<double>& image, double sigma) {
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

// place: of the specimen, in steps of the scan; blur: pixels a step.
std::vector<Grid<float>> flat_at(double place, double blur, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Grid<double> texture(side, side);
    std::ranges::generate(texture.values, [&] { return normal(random); });
    std::vector<Grid<float>> stack;
    for (int image = 0; image < images; ++image) {
        const Grid<double> seen = blurred(texture, std::hypot(0.9, blur * (image - place)));
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

Found found_at(double place, double blur, unsigned seed, std::optional<double> smoothing = {}) {
    const auto stack = flat_at(place, blur, seed);
    std::vector<double> z(static_cast<std::size_t>(images));
    std::iota(z.begin(), z.end(), 0.0);
    const Topography topography = reconstruct(stack, z, 0, 0, 1, {.smoothing_steps = smoothing});
    Found found{.width = topography.stack.curve_width_steps};
    int measured = 0, beyond = 0;
    for (std::size_t k = 0; k < topography.state.values.size(); ++k) {
        if (topography.state.values[k] == PointState::measured) {
            const double off = topography.height.height.values[k] - place;
            ++measured;
            found.bias += off;
            beyond += std::abs(off) > 3 * topography.height_uncertainty.values[k] ? 1 : 0;
        }
    }
    found.measured = measured / static_cast<double>(side * side);
    found.bias /= std::max(1, measured);
    found.beyond = beyond / static_cast<double>(std::max(1, measured));
    return found;
}

TEST(NearTheEnds, WhatIsInTheScanIsMeasured) {
    for (const double blur : {0.5, 0.35, 0.25, 0.19}) {
        double beyond = 0;
        int cases = 0;
        for (const double from_end : {3.0, 3.5, 4.0, 6.0}) {
            for (const bool last : {false, true}) {
                const double place = last ? images - 1 - from_end : from_end;
                const Found found = found_at(place, blur, 1);
                SCOPED_TRACE(testing::Message() << "place " << place << ", curves " << found.width << " steps wide");
                EXPECT_GE(found.measured, 0.95);
                EXPECT_NEAR(found.bias, 0, 0.1);
                beyond += found.beyond;
                ++cases;
            }
        }
        EXPECT_LE(beyond / cases, 0.015) << "blur " << blur;
    }
}

TEST(NearTheEnds, AnAverageAsWideAsTheCurvesAllowLosesIt) {
    // The wrong twin: what suits the curves' width in the middle of the scan.
    const Found found = found_at(3, 0.19, 1, most_smoothing_of_width * 2.8);
    EXPECT_GT(found.width, 2);
    EXPECT_LT(found.measured, 0.5);
}

TEST(NearTheEnds, CurvesInTheMiddleAreAveragedAsBefore) {
    FocusProbes probes(side, side, FocusMeasure::wavelet, FocusWindow(7, WindowShape::box));
    for (const auto& image : flat_at(20, 0.19, 2)) {
        probes.add({image});
    }
    EXPECT_EQ(probes.suitable_smoothing(), suitable_smoothing(probes.curve_width(), images));
}

} // namespace
} // namespace vkfv::topography
