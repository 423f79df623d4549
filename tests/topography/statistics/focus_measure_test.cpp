#include "topography/focus_measure.hpp"

#include "core/messages/error.hpp"
#include "topography/noise/noise_gain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr std::array all_measures = {FocusMeasure::standard_deviation,
                                     FocusMeasure::tenengrad,
                                     FocusMeasure::modified_laplacian,
                                     FocusMeasure::brenner,
                                     FocusMeasure::wavelet,
                                     FocusMeasure::gradient_and_curvature};

bool adds_magnitudes(FocusMeasure measure) {
    return measure == FocusMeasure::modified_laplacian || measure == FocusMeasure::gradient_and_curvature;
}

Grid<float> noise_image(int columns, int rows, double mean, double deviation, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(mean, deviation);
    Grid<float> image(columns, rows);
    for (float& value : image.values)
        value = static_cast<float>(normal(random));
    return image;
}

double pixel(const Grid<float>& image, int i, int j) {
    const auto mirror = [](int k, int n) { return k < 0 ? -k : k >= n ? 2 * n - 2 - k : k; };
    return image(mirror(i, image.columns), mirror(j, image.rows));
}

// The response's energy at a pixel by its definition, written as masks.
double energy(const Grid<float>& image, FocusMeasure measure, int i, int j) {
    const auto masked = [&](const std::vector<std::vector<double>>& mask) {
        const int radius = static_cast<int>(mask.size()) / 2;
        double sum = 0;
        for (int dj = -radius; dj <= radius; ++dj)
            for (int di = -radius; di <= radius; ++di)
                sum += mask[static_cast<std::size_t>(dj + radius)][static_cast<std::size_t>(di + radius)] *
                       pixel(image, i + di, j + dj);
        return sum;
    };
    const auto squares = [&](std::vector<std::vector<double>> mask) {
        const double along_x = masked(mask);
        std::vector<std::vector<double>> transposed = mask;
        for (std::size_t row = 0; row < mask.size(); ++row)
            for (std::size_t column = 0; column < mask.size(); ++column)
                transposed[column][row] = mask[row][column];
        return along_x * along_x + std::pow(masked(transposed), 2);
    };
    const auto outer = [](const std::vector<double>& x, const std::vector<double>& y) {
        std::vector<std::vector<double>> mask(5, std::vector<double>(5));
        for (std::size_t row = 0; row < 5; ++row)
            for (std::size_t column = 0; column < 5; ++column)
                mask[row][column] = x[column] * y[row];
        return mask;
    };
    const std::vector<double> low = {-1 / 8., 2 / 8., 6 / 8., 2 / 8., -1 / 8.}, high = {0, -1 / 2., 1, -1 / 2., 0};
    switch (measure) {
    case FocusMeasure::tenengrad:
        return squares({{-1, 0, 1}, {-2, 0, 2}, {-1, 0, 1}});
    case FocusMeasure::brenner:
        return squares({{0, 0, 0}, {-1, 0, 1}, {0, 0, 0}});
    case FocusMeasure::wavelet:
        return squares(outer(low, high)) + std::pow(masked(outer(high, high)), 2);
    case FocusMeasure::modified_laplacian:
        return std::pow(std::abs(masked({{0, 0, 0}, {-1, 2, -1}, {0, 0, 0}})) +
                            std::abs(masked({{0, -1, 0}, {0, 2, 0}, {0, -1, 0}})),
                        2);
    case FocusMeasure::gradient_and_curvature:
        return squares({{-1, 0, 1}, {-2, 0, 2}, {-1, 0, 1}}) + 0.5 * squares({{-1, 2, -1}, {-2, 4, -2}, {-1, 2, -1}});
    case FocusMeasure::standard_deviation:
        return 0;
    }
    return 0;
}

// The measure by its definition, window by window, with sums of all pixels at once.
double direct_measure(const Channels& image, FocusMeasure measure, int window,
                      const std::function<double(int)>& weight_at, int column, int row) {
    const int radius = window / 2;
    double total = 0, brightness = 0, gathered = 0;
    const auto visit = [&](const auto& task) {
        for (int j = std::max(0, row - radius); j <= std::min(image[0].rows - 1, row + radius); ++j)
            for (int i = std::max(0, column - radius); i <= std::min(image[0].columns - 1, column + radius); ++i)
                task(i, j, weight_at(i - column) * weight_at(j - row));
    };
    std::vector<double> means(image.size());
    visit([&](int i, int j, double weight) {
        total += weight;
        for (std::size_t c = 0; c < image.size(); ++c)
            means[c] += weight * image[c](i, j);
    });
    for (double& mean : means)
        brightness += (mean /= total) / static_cast<double>(means.size());
    visit([&](int i, int j, double weight) {
        double sum = 0;
        for (std::size_t c = 0; c < image.size(); ++c)
            sum += measure == FocusMeasure::standard_deviation ? std::pow(image[c](i, j) - means[c], 2)
                                                               : energy(image[c], measure, i, j);
        gathered += weight * (adds_magnitudes(measure) ? std::sqrt(sum) : sum);
    });
    gathered /= total;
    return (adds_magnitudes(measure) ? gathered : std::sqrt(gathered)) /
           (brightness * std::sqrt(static_cast<double>(image.size())));
}

TEST(FocusMeasure, IsItsDefinitionInEveryWindow) {
    const Channels grey = {noise_image(23, 17, 200, 15, 1)};
    const Channels colour = {grey[0], noise_image(23, 17, 100, 20, 2), noise_image(23, 17, 300, 5, 3)};
    for (const auto measure : all_measures)
        for (const Channels& image : {grey, colour})
            for (const int window : {3, 7, 15, 41})
                for (const auto shape : {WindowShape::box, WindowShape::gaussian}) {
                    const auto weight = [&](int d) {
                        return shape == WindowShape::box ? 1 : std::exp(-0.5 * std::pow(d / (window / 5.0), 2));
                    };
                    const auto result = focus_measure(image, measure, FocusWindow(window, shape));
                    for (int row = 0; row < result.rows; ++row)
                        for (int column = 0; column < result.columns; ++column)
                            // Results below 2 are in float32.
                            EXPECT_NEAR(result(column, row),
                                        direct_measure(image, measure, window, weight, column, row), 1.2e-7)
                                << static_cast<int>(measure) << " " << window << " " << column << " " << row;
                }
}

TEST(FocusMeasure, DoesNotDependOnBrightnessNorOnChannelsOfTheSameGrey) {
    const auto image = noise_image(16, 16, 200, 15, 2);
    Grid<float> brighter = image;
    for (float& value : brighter.values)
        value *= 1024; // exact
    const FocusWindow window(5, WindowShape::box);
    for (const auto measure : all_measures) {
        const auto values = focus_measure({image}, measure, window).values;
        EXPECT_EQ(values, focus_measure({brighter}, measure, window).values);
        const auto of_colour = focus_measure({image, image, image}, measure, window).values;
        for (std::size_t k = 0; k < values.size(); ++k)
            EXPECT_NEAR(of_colour[k], values[k], 1.2e-7); // float32 of results below 2
        EXPECT_EQ(focus_measure({Grid<float>(9, 9)}, measure, window).values, std::vector<float>(81, 0.0f));
    }
}

TEST(FocusMeasure, ImagesOfOneRowOrPixelHaveAMeasure) {
    for (const auto measure : all_measures) {
        EXPECT_EQ(focus_measure({Grid<float>(1, 1, 3.0f)}, measure, FocusWindow(3, WindowShape::box)).values,
                  std::vector<float>(1, 0.0f));
        const auto row = focus_measure({noise_image(9, 1, 200, 15, 2)}, measure, FocusWindow(3, WindowShape::box));
        EXPECT_GT(row(4, 0), 0);
    }
}

TEST(FocusMeasure, RowsSharedAmongThreadsGiveWhatOneRowAloneGives) {
    // The image is large enough for several threads; a strip cut out with its margins stays on one.
    const auto image = noise_image(256, 600, 200, 15, 3);
    Grid<float> strip(256, 40);
    std::copy_n(image.values.begin() + 256 * 290, strip.values.size(), strip.values.begin());
    for (const auto measure : {FocusMeasure::modified_laplacian, FocusMeasure::standard_deviation}) {
        const FocusWindow window(7, WindowShape::box);
        const auto whole = focus_measure({image}, measure, window);
        const auto part = focus_measure({strip}, measure, window);
        for (int row = 5; row < 35; ++row)
            for (int column = 0; column < 256; ++column)
                EXPECT_EQ(whole(column, 290 + row), part(column, row));
    }
}

// The standard deviation of the measure of images of noise over a texture, over noise_gain(). Windows do not overlap:
// 400 in an image. The texture is the same in all images of one seed: deviations are from each place's own mean.
double gain_over_model(FocusMeasure measure, const FocusWindow& window, double texture, unsigned seed) {
    constexpr int side = 420, images = 12, spacing = 21;
    constexpr double relative_noise = 0.002;
    const auto base = noise_image(side, side, 100, 100 * texture, seed);
    std::vector<double> sums(400), squares(400);
    double gains = 0;
    for (unsigned k = 0; k < images; ++k) {
        auto image = noise_image(side, side, 0, 100 * relative_noise, 1000 * seed + k);
        for (std::size_t p = 0; p < image.values.size(); ++p)
            image.values[p] += base.values[p];
        const auto result = focus_measure({image}, measure, window);
        std::size_t place = 0;
        for (int row = spacing / 2; row < side; row += spacing)
            for (int column = spacing / 2; column < side; column += spacing, ++place) {
                sums[place] += result(column, row);
                squares[place] += std::pow(result(column, row), 2);
            }
    }
    double variance = 0;
    for (std::size_t place = 0; place < 400; ++place) {
        const double mean = sums[place] / images;
        variance += (squares[place] / images - mean * mean) * images / (images - 1) / 400;
    }
    gains = noise_gain(measure, window.pixels(side, side, side / 2, side / 2)) * relative_noise;
    return std::sqrt(variance) / gains;
}

TEST(FocusMeasure, NoiseGainIsThatOfNoise) {
    // With 400 places of 11 degrees of freedom each a standard deviation is known to 1 / sqrt(2 * 4400) = 1.07 %; five
    // of these (rate 6e-7) are 5.4 %. Narrow windows average less of what correlates between pixels by up to the masks'
    // width over the window's, a quarter for the wavelet's 5 of 19 pixels at both edges; and without texture the root
    // of the energies has 1 / sqrt(2) of the noise, the modified Laplacian sqrt(12.02 / 27.9), gradient and curvature
    // sqrt(0.44).
    const FocusWindow box(19, WindowShape::box), gaussian(21, WindowShape::gaussian);
    for (const auto measure : all_measures)
        for (const FocusWindow& window : {box, gaussian}) {
            const double with_texture = gain_over_model(measure, window, 0.1, 10);
            EXPECT_LT(with_texture, 1.054) << static_cast<int>(measure);
            EXPECT_GT(with_texture, 0.80) << static_cast<int>(measure);
            const double without = gain_over_model(measure, window, 0, 11);
            const double expected = std::sqrt(measure == FocusMeasure::modified_laplacian       ? 12.02 / 27.9
                                              : measure == FocusMeasure::gradient_and_curvature ? 0.44
                                                                                                : 0.5);
            EXPECT_LT(without, 1.054 * expected) << static_cast<int>(measure);
            EXPECT_GT(without, 0.80 * expected) << static_cast<int>(measure);
        }
}

TEST(FocusMeasure, IsKnownByName) {
    for (const auto measure : all_measures)
        EXPECT_EQ(focus_measure_from_name(name_of(measure)), measure);
    EXPECT_EQ(focus_measure_from_name("wavelet"), FocusMeasure::wavelet);
    EXPECT_THROW(focus_measure_from_name("sharpness"), InputError);
    EXPECT_EQ(window_shape_from_name(name_of(WindowShape::gaussian)), WindowShape::gaussian);
    EXPECT_EQ(window_shape_from_name("box"), WindowShape::box);
    EXPECT_THROW(window_shape_from_name("round"), InputError);
}

} // namespace
} // namespace vkfv::topography
