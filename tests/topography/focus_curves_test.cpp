// The focus curves that are kept for people are those by which the heights are found.
#include "topography/topography.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

using testing::ElementsAre;

constexpr int curve_columns = 23, curve_rows = 17, curve_images = 21;
constexpr double curve_step = 0.0015;

// A stack of texture that is in focus at a height which grows along x.
std::vector<Grid<float>> tilted_stack() {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    Grid<double> texture(curve_columns, curve_rows);
    for (double& value : texture.values)
        value = 0.2 * normal(random);
    std::vector<Grid<float>> images;
    for (int k = 0; k < curve_images; ++k) {
        Grid<float>& image = images.emplace_back(curve_columns, curve_rows);
        for (int row = 0; row < curve_rows; ++row)
            for (int column = 0; column < curve_columns; ++column) {
                const double blur = (k - 6.3 - 0.3 * column) / 2.5;
                image(column, row) = static_cast<float>(1 + texture(column, row) * std::exp(-blur * blur / 2));
            }
    }
    return images;
}

Topography evaluated_with(const TopographyOptions& options, const CurveGrid& grid) {
    StackEvaluator evaluator(options, make_reference_focus_planes, grid); // to the digits of double
    const auto images = tilted_stack();
    for (int k = 0; k < curve_images; ++k)
        evaluator.add(images[static_cast<std::size_t>(k)], k * curve_step);
    return evaluator.finish(0, 0, 0.001);
}

TEST(FocusCurves, AreThoseOfTheDefinition) {
    const TopographyOptions options{
        .focus_measure = FocusMeasure::tenengrad, .smoothing_steps = 0.7, .place_by_texture = false};
    const auto topography = evaluated_with(options, {.columns = 4, .rows = 3});
    const FocusCurves& curves = topography.curves;
    EXPECT_THAT(curves.columns, ElementsAre(2, 8, 14, 20)); // 23 / 8 of 1, 3, 5, 7
    EXPECT_THAT(curves.rows, ElementsAre(2, 8, 14));
    ASSERT_EQ(curves.z.size(), static_cast<std::size_t>(curve_images));
    const auto images = tilted_stack();
    const auto weights = axial_weights(0.7);
    const FocusWindow window(options.window_px, options.window_shape);
    std::vector<Grid<float>> averaged;
    for (int at = 0; at < curve_images; ++at) {
        Grid<float>& mean = averaged.emplace_back(curve_columns, curve_rows);
        for (const Share& share : axial_shares(weights, at, curve_images))
            for (std::size_t p = 0; p < mean.values.size(); ++p)
                mean.values[p] += share.weight * images[static_cast<std::size_t>(share.image)].values[p];
    }
    for (std::size_t row = 0; row < curves.rows.size(); ++row)
        for (std::size_t column = 0; column < curves.columns.size(); ++column)
            for (int at = 0; at < curve_images; ++at) {
                double value = 0;
                for (const Share& share : axial_shares(weights, at, curve_images))
                    value += share.weight * focus_at({averaged[static_cast<std::size_t>(share.image)]},
                                                     options.focus_measure.value(), window, curves.columns[column],
                                                     curves.rows[row]);
                const std::size_t place = curves.index(column, row) * curves.z.size() + static_cast<std::size_t>(at);
                EXPECT_NEAR(curves.values[place], value, 2e-6 * value); // a few roundings of float
            }
}

TEST(FocusCurves, HaveThePeaksThatTheHeightsAre) {
    for (const PeakMethod method : {PeakMethod::gaussian, PeakMethod::parabola, PeakMethod::gaussian_fit,
                                    PeakMethod::polynomial_fit, PeakMethod::centre_of_gravity}) {
        const auto topography =
            evaluated_with({.peak = method, .smoothing_steps = 0, .false_peak_rate = 1, .place_by_texture = false},
                           {.columns = 64, .rows = 2});
        const FocusCurves& curves = topography.curves;
        ASSERT_EQ(curves.columns.size(), static_cast<std::size_t>(curve_columns)); // there are no more
        int measured = 0;
        for (std::size_t row = 0; row < curves.rows.size(); ++row)
            for (std::size_t column = 0; column < curves.columns.size(); ++column) {
                const double height = topography.height.height(curves.columns[column], curves.rows[row]);
                if (std::isnan(height))
                    continue;
                ++measured;
                const std::size_t point = curves.index(column, row);
                EXPECT_DOUBLE_EQ(curves.peaks[point], height);
                const CurveFit& fit = curves.fits[point];
                if (method == PeakMethod::centre_of_gravity) {
                    EXPECT_EQ(fit.range, 0);
                    continue;
                }
                // The fit has its maximum at this place. The fit is made of float values, and the peak of the same
                // values in double.
                const auto& [c0, c1, c2] = fit.coefficients;
                EXPECT_NEAR(fit.at - c1 / (2 * c2), height / curve_step, 1e-9);
                if (method == PeakMethod::gaussian) { // through three values
                    const float* at = &curves.values[point * curves.z.size() + static_cast<std::size_t>(fit.at)];
                    for (const int x : {-1, 0, 1})
                        EXPECT_NEAR(fit.largest * std::exp(c0 + c1 * x + c2 * x * x), at[x], 1e-9 * fit.largest);
                }
            }
        EXPECT_GT(measured, 40) << name_of(method);
    }
}

TEST(FocusCurves, OfLongStacksAreThinnedOut) {
    const TopographyOptions options{.smoothing_steps = 0.7};
    const auto whole = evaluated_with(options, {.columns = 3, .rows = 2}).curves;
    const auto thinned = evaluated_with(options, {.columns = 3, .rows = 2, .every = 4}).curves;
    ASSERT_EQ(thinned.z.size(), 6u); // 0, 4 ... 20
    EXPECT_EQ(thinned.peaks, whole.peaks);
    for (std::size_t point = 0; point < 6; ++point) {
        EXPECT_EQ(thinned.fits[point].range, 0);
        for (std::size_t k = 0; k < 6; ++k)
            EXPECT_EQ(thinned.values[point * 6 + k], whole.values[point * whole.z.size() + 4 * k]);
    }
    EXPECT_TRUE(evaluated_with(options, {}).curves.values.empty());
}

} // namespace
} // namespace vkfv::topography
