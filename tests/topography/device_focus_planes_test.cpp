// The evaluation of stacks in float has the same bits on host and device, and is right by the reference in double.
#include "topography/device_focus_planes.hpp"
#include "topography/topography.hpp"
#include "vulkan/device.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace vkfv::topography {
namespace {

using topography::Channels;

constexpr int columns = 37, rows = 29, images = 24;
constexpr double step = 0.001;

// A stack whose texture's contrast is a Gaussian along z about a height that varies over the image, with noise.
std::vector<Channels> stack(int channels) {
    std::mt19937 random(4);
    std::normal_distribution<double> normal;
    Channels texture(static_cast<std::size_t>(channels), Grid<float>(columns, rows));
    for (auto& channel : texture)
        for (float& value : channel.values)
            value = static_cast<float>(0.2 * normal(random));
    std::vector<Channels> result;
    for (int k = 0; k < images; ++k) {
        Channels& image = result.emplace_back(texture);
        for (auto& channel : image)
            for (int row = 0; row < rows; ++row)
                for (int column = 0; column < columns; ++column) {
                    const double height = 11 + 4 * std::sin(0.2 * column) * std::cos(0.15 * row);
                    float& value = channel(column, row);
                    value = static_cast<float>(
                        1e-9 * (1 + value * std::exp(-0.5 * std::pow((k - height) / 3, 2)) + 0.002 * normal(random)));
                }
    }
    return result;
}

topography::Topography evaluated(const std::vector<Channels>& stack, const topography::TopographyOptions& options,
                                 const topography::FocusPlanesMaker& maker) {
    topography::StackEvaluator evaluator(options, maker, {.columns = 5, .rows = 40, .every = 3});
    for (int k = 0; k < images; ++k)
        evaluator.add(stack[static_cast<std::size_t>(k)], k * step);
    return evaluator.finish(0, 0, 0.002);
}

// The bounds follow from u = 2^-24. A value of a curve is a chain of at most 160 float operations without cancellation
// (means of at most 11 images and curves, masks of 25 pixels, two windows of 7 and their squares) on positive numbers,
// except that masks subtract pixels of 1 that differ by 0.02 or more over a window: their differences have u / 0.02 =
// 50 u each, at random. So a curve's values are right to 200 u = 1.2e-5. Around the maximum the curve bends by 1 / 3^2
// a step^2, or less where the averages widen it, some 1 / 15: a position, difference of values over twice the bend, is
// right to 1.2e-5 * 15 = 2e-4 steps.
constexpr double value_bound = 1.2e-5, position_bound = 2e-4;

void expect_near(const topography::Topography& host, const topography::Topography& device, const std::string& which) {
    int compared = 0, other_image = 0;
    for (std::size_t k = 0; k < host.state.values.size(); ++k) {
        const double a = host.height.height.values[k], b = device.height.height.values[k];
        // Two values of the curve may be so near each other that rounding decides which is the largest: a three-point
        // fit is continuous there, fits over a range are not; few points are on such an edge.
        if (host.state.values[k] != device.state.values[k] || std::abs(a - b) > 0.2 * step) {
            ++other_image;
            continue;
        }
        EXPECT_NEAR(device.contrast.values[k] / host.contrast.values[k], 1, 10 * value_bound) << which;
        if (std::isnan(a))
            continue;
        ++compared;
        EXPECT_NEAR(b / step, a / step, position_bound) << which;
        EXPECT_NEAR(device.fit_residual.values[k], host.fit_residual.values[k], 2 * value_bound) << which;
        // The value is linear between two images that differ by less than themselves.
        for (std::size_t channel = 0; channel < host.all_in_focus.size(); ++channel)
            EXPECT_NEAR(device.all_in_focus[channel].values[k] / host.all_in_focus[channel].values[k], 1,
                        position_bound)
                << which;
    }
    ASSERT_EQ(device.curves.values.size(), 5u * rows * 8);
    ASSERT_EQ(host.curves.values.size(), device.curves.values.size());
    for (std::size_t k = 0; k < host.curves.values.size(); ++k)
        EXPECT_NEAR(device.curves.values[k] / host.curves.values[k], 1, 10 * value_bound) << which;
    EXPECT_GT(compared, columns * rows * 9 / 10) << which;
    EXPECT_LE(other_image, 2) << which; // points of 1073
}

// Compares numbers bit by bit; values that are not a number are alike too.
template <class Number>
void expect_bits(const Grid<Number>& a, const Grid<Number>& b, const std::string& which) {
    ASSERT_EQ(a.values.size(), b.values.size());
    EXPECT_EQ(std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(Number)), 0) << which;
}

void expect_bits(const Topography& a, const Topography& b, const std::string& which) {
    expect_bits(a.height.height, b.height.height, which + ": height");
    expect_bits(a.height_noise, b.height_noise, which + ": height noise");
    expect_bits(a.height_uncertainty, b.height_uncertainty, which + ": height uncertainty");
    expect_bits(a.contrast, b.contrast, which + ": contrast");
    expect_bits(a.fit_residual, b.fit_residual, which + ": fit residual");
    expect_bits(a.state, b.state, which + ": state");
    for (std::size_t channel = 0; channel < a.all_in_focus.size(); ++channel) {
        expect_bits(a.all_in_focus[channel], b.all_in_focus[channel], which + ": all in focus");
    }
    EXPECT_EQ(a.curves.values, b.curves.values) << which;
}

// Expects that host and device are alike, and that both are near the reference.
void expect_alike(const std::vector<Channels>& images, const TopographyOptions& options, const std::string& which) {
    const auto host = evaluated(images, options, make_host_focus_planes);
    expect_bits(host, evaluated(images, options, device_focus_planes(std::make_shared<const vulkan::Device>())), which);
    expect_near(evaluated(images, options, make_reference_focus_planes), host, which);
}

// Responses and peaks are found apart, so each measure goes with one method of peaks, and each method with a measure of
// energies and one of magnitudes.
TEST(DeviceFocusPlanes, GiveTheHostsBitsByEveryMeasureAndPeakMethod) {
    const auto grey = stack(1);
    for (const auto& measure : focus_measure_names()) {
        for (const auto& peak : peak_method_names()) {
            if (measure == name_of(FocusMeasure::wavelet) || measure == name_of(FocusMeasure::modified_laplacian) ||
                peak == name_of(PeakMethod::gaussian_fit)) {
                expect_alike(
                    grey,
                    {.focus_measure = focus_measure_from_name(measure),
                     .peak = peak_method_from_name(peak),
                     .peak_range_steps = 5, // with these, 11 images and curves are taken together: two dispatches
                     .smoothing_steps = 1.5,
                     .false_peak_rate = 1},
                    fmt::format("{} {}", measure, peak));
            }
        }
    }
}

TEST(DeviceFocusPlanes, GiveTheHostsBitsOfColourAndWithAGaussianWindow) {
    const auto colour = stack(3);
    for (const auto measure : {FocusMeasure::standard_deviation, FocusMeasure::tenengrad}) {
        expect_alike(
            colour,
            {.focus_measure = measure, .window_px = 7, .window_shape = WindowShape::gaussian, .smoothing_steps = 0},
            name_of(measure));
    }
}

// Errors are in units in the last place of float, 2^-23 of the number to 2^-24.
TEST(FocusArithmetic, IsNearlyAsGoodAsFloatsOwn) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> exponent(-99, 99), small(-86, 1);
    const auto units = [](float found, double exact) { return std::abs(found / exact - 1) * 0x1p23; };
    double division = 0, root = 0, logarithm = 0, exponential = 0;
    for (int k = 0; k < 200'000; ++k) {
        const float a = std::exp2(exponent(random)),
                    b = std::exp2(exponent(random) / 99 * (99 - std::abs(std::log2(a))));
        const double exact_a = a;
        division = std::max(division, units(focus::f32::quotient(-a, b), -exact_a / b));
        root = std::max(root, units(focus::f32::root(a), std::sqrt(exact_a)));
        logarithm = std::max(logarithm, std::abs(focus::f32::natural_log(a) - std::log(exact_a)) /
                                            std::max(1.0, std::abs(std::log(exact_a))) * 0x1p23);
        const float power = small(random);
        exponential = std::max(exponential, units(focus::f32::exponential(power), std::exp(double{power})));
    }
    EXPECT_LT(division, 2);
    EXPECT_LT(root, 2);
    EXPECT_LT(logarithm, 2);
    EXPECT_LT(exponential, 2);
    EXPECT_EQ(focus::f32::root(0), 0);
    EXPECT_EQ(focus::f32::quotient(0, 3), 0);
    EXPECT_EQ(focus::f32::exponential(-200), 0);
    EXPECT_EQ(focus::f32::exponential(0), 1);
    EXPECT_EQ(focus::f32::natural_log(1), 0);
}

// The wrong twin is another method, which is told apart.
TEST(DeviceFocusPlanes, TheBoundTellsMethodsApart) {
    const auto grey = stack(1);
    const auto a =
        evaluated(grey, {.peak = PeakMethod::gaussian, .smoothing_steps = 0.9}, topography::make_host_focus_planes);
    const auto b =
        evaluated(grey, {.peak = PeakMethod::parabola, .smoothing_steps = 0.9}, topography::make_host_focus_planes);
    int apart = 0;
    for (std::size_t k = 0; k < a.height.height.values.size(); ++k)
        apart += std::abs(a.height.height.values[k] - b.height.height.values[k]) > position_bound * step;
    EXPECT_GT(apart, columns * rows / 2);
}

} // namespace
} // namespace vkfv::topography
