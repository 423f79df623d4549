#include "topography/axial_average.hpp"
#include "topography/focus_measure.hpp"
#include "topography/peak.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

TEST(GaussianPeak, IsExactForAGaussianAnywhereBetweenSteps) {
    for (double centre = -0.5; centre <= 0.5; centre += 0.0625)
        for (const double width : {0.7, 3.0, 10.0}) {
            const auto value = [=](double z) {
                return 5 * std::exp(-0.5 * std::pow((z - centre) / width, 2));
            };
            // The logarithms' rounding, 2e-16, is divided by the curvature 1 / width^2 >= 0.01.
            EXPECT_NEAR(gaussian_peak_offset(value(-1), value(0), value(1)), centre, 1e-13);
        }
    // The wrong twin, a parabola through the values themselves, is off by more than 0.02 steps.
    const auto value = [](double z) { return std::exp(-0.5 * std::pow((z - 0.3) / 0.7, 2)); };
    const double a = value(-1), b = value(0), c = value(1);
    EXPECT_GT(std::abs((a - c) / (2 * (a - 2 * b + c)) - 0.3), 0.02);
}

TEST(GaussianPeak, HasNoOffsetWithoutAPeak) {
    EXPECT_TRUE(std::isnan(gaussian_peak_offset(1, 1, 1)));
    EXPECT_TRUE(std::isnan(gaussian_peak_offset(1, 2, 3)));
    EXPECT_TRUE(std::isnan(gaussian_peak_offset(2, 1, 2)));
    EXPECT_TRUE(std::isnan(gaussian_peak_offset(0, 1, 0.5)));
    EXPECT_DOUBLE_EQ(gaussian_peak_offset(1, 2, 2), 0.5);
}

double tracked_position(const std::vector<float>& curve) {
    PeakTracker tracker;
    for (const float value : curve)
        tracker.add(Grid<float>(1, 1, value));
    return tracker.position(0, 0);
}

TEST(PeakTracker, FindsTheHighestOfSeveralPeaksAndNoneAtTheEnds) {
    EXPECT_DOUBLE_EQ(tracked_position({1, 2, 1, 1, 4, 1}), 4);
    EXPECT_DOUBLE_EQ(tracked_position({1, 4, 1, 1, 2, 1}), 1);
    EXPECT_TRUE(std::isnan(tracked_position({5, 4, 3, 2, 1})));
    EXPECT_TRUE(std::isnan(tracked_position({1, 2, 3, 4, 5})));
    EXPECT_TRUE(std::isnan(tracked_position({3, 3, 3, 3})));
    PeakTracker tracker;
    for (const float value : {1.0f, 4.0f, 1.0f})
        tracker.add(Grid<float>(1, 1, value));
    EXPECT_DOUBLE_EQ(tracker.prominence(0, 0), 2);
}

TEST(AxialAverage, IsTheNormalisedWeightedMeanAlsoAtTheEnds) {
    const std::vector<float> values = {3, -1, 4, 1, -5, 9, 2, 6};
    for (const double s : {0.0, 0.5, 1.0, 4.0}) {
        AxialAverage average(s);
        std::vector<float> result;
        const auto sink = [&](const Grid<float>& image) { result.push_back(image(0, 0)); };
        for (const float value : values)
            average.push(Grid<float>(1, 1, value), sink);
        average.flush(sink);
        ASSERT_EQ(result.size(), values.size());
        for (int k = 0; k < static_cast<int>(values.size()); ++k) {
            double sum = 0, weights = 0;
            for (int i = 0; i < static_cast<int>(values.size()); ++i) {
                const double weight = i == k ? 1
                                      : std::abs(i - k) <= std::ceil(3 * s)
                                          ? std::exp(-0.5 * std::pow((i - k) / s, 2))
                                          : 0;
                sum += weight * values[static_cast<std::size_t>(i)];
                weights += weight;
            }
            // Eight float32 terms below 9.
            EXPECT_NEAR(result[static_cast<std::size_t>(k)], sum / weights, 9 * 8 * 6e-8);
        }
    }
}

Grid<float> noise_image(int columns, int rows, double mean, double deviation, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(mean, deviation);
    Grid<float> image(columns, rows);
    for (float& value : image.values)
        value = static_cast<float>(normal(random));
    return image;
}

// The definition, window by window.
double direct_measure(const Grid<float>& image, FocusMeasure measure, int window, int column, int row) {
    const int radius = window / 2;
    const auto at = [&](int i, int j) {
        const auto mirror = [](int k, int n) { return k < 0 ? -k : k >= n ? 2 * n - 2 - k : k; };
        return static_cast<double>(image(mirror(i, image.columns), mirror(j, image.rows)));
    };
    double n = 0, sum = 0, squares = 0, laplacian = 0;
    for (int j = std::max(0, row - radius); j <= std::min(image.rows - 1, row + radius); ++j)
        for (int i = std::max(0, column - radius); i <= std::min(image.columns - 1, column + radius); ++i) {
            n += 1;
            sum += at(i, j);
            squares += at(i, j) * at(i, j);
            laplacian += std::abs(2 * at(i, j) - at(i - 1, j) - at(i + 1, j)) +
                         std::abs(2 * at(i, j) - at(i, j - 1) - at(i, j + 1));
        }
    return measure == FocusMeasure::standard_deviation
               ? std::sqrt(squares / n - sum * sum / n / n) / (sum / n)
               : laplacian / sum;
}

TEST(FocusMeasure, IsItsDefinitionInEveryWindow) {
    const auto image = noise_image(23, 17, 200, 15, 1);
    for (const auto measure : {FocusMeasure::standard_deviation, FocusMeasure::modified_laplacian})
        for (const int window : {3, 7, 15, 41}) {
            const auto result = focus_measure(image, measure, window);
            for (int row = 0; row < image.rows; ++row)
                for (int column = 0; column < image.columns; ++column)
                    // float32 of the Laplacian and of the result, each to 6e-8 of at most 0.5
                    EXPECT_NEAR(result(column, row), direct_measure(image, measure, window, column, row),
                                1e-7)
                        << window << " " << column << " " << row;
        }
}

TEST(FocusMeasure, DoesNotDependOnBrightness) {
    const auto image = noise_image(16, 16, 200, 15, 2);
    Grid<float> brighter = image;
    for (float& value : brighter.values)
        value *= 1024; // exact
    for (const auto measure : {FocusMeasure::standard_deviation, FocusMeasure::modified_laplacian})
        EXPECT_EQ(focus_measure(image, measure, 5).values, focus_measure(brighter, measure, 5).values);
    EXPECT_EQ(focus_measure(Grid<float>(9, 9), FocusMeasure::standard_deviation, 3).values,
              std::vector<float>(81, 0.0f));
}

TEST(FocusMeasure, RowsSharedAmongThreadsGiveWhatOneRowAloneGives) {
    // Large enough for several threads; a strip cut out with its margins stays on one.
    const auto image = noise_image(512, 600, 200, 15, 3);
    Grid<float> strip(512, 40);
    std::copy_n(image.values.begin() + 512 * 290, strip.values.size(), strip.values.begin());
    const auto whole = focus_measure(image, FocusMeasure::modified_laplacian, 7);
    const auto part = focus_measure(strip, FocusMeasure::modified_laplacian, 7);
    for (int row = 5; row < 35; ++row)
        for (int column = 0; column < 512; ++column)
            // The sums are taken about different image means: float32 of the result.
            EXPECT_NEAR(whole(column, 290 + row), part(column, row), 1e-7);
    EXPECT_EQ(whole.values, focus_measure(image, FocusMeasure::modified_laplacian, 7).values);
}

TEST(FocusMeasure, NoiseGainIsThatOfNoise) {
    // Windows that do not overlap: m = (280/14)^2 = 400 independent measures in each of 5 images; the
    // standard deviation of 2000 normal values is known to 1 / sqrt(4000) = 1.6 %; five of these (rate 6e-7)
    // are 8 %.
    const int window = 7;
    for (const auto measure : {FocusMeasure::standard_deviation, FocusMeasure::modified_laplacian}) {
        const double relative_noise = 0.01;
        double sum = 0, squares = 0, n = 0;
        for (unsigned seed = 0; seed < 5; ++seed) {
            const auto result =
                focus_measure(noise_image(280, 280, 100, 100 * relative_noise, 10 + seed), measure, window);
            for (int row = 7; row < 280; row += 14)
                for (int column = 7; column < 280; column += 14) {
                    sum += result(column, row);
                    squares += static_cast<double>(result(column, row)) * result(column, row);
                    n += 1;
                }
        }
        const double deviation = std::sqrt(squares / n - sum * sum / n / n);
        double gain = noise_gain(measure, window * window) * relative_noise;
        if (measure == FocusMeasure::standard_deviation)
            gain /= std::sqrt(2.0); // without texture
        EXPECT_NEAR(deviation / gain, 1, 0.08);
    }
}

TEST(FocusMeasure, IsKnownByName) {
    EXPECT_EQ(focus_measure_from_name("standard-deviation"), FocusMeasure::standard_deviation);
    EXPECT_EQ(focus_measure_from_name("modified-laplacian"), FocusMeasure::modified_laplacian);
    EXPECT_THROW(focus_measure_from_name("sharpness"), InputError);
}

} // namespace
} // namespace vkfv::topography
