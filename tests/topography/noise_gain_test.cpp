// Noise of focus measures and of heights where neighbouring pixels' noise is correlated.
#include "topography/noise_gain.hpp"

#include "topography/blurred_noise.hpp"
#include "topography/topography.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

using test::BlurredNoise;

struct Blur {
    double aperture, pitch; // mm
};
constexpr std::array blurs = {Blur{0.28, 1e-3}, Blur{0.41, 0.5e-3}, Blur{0.66, 0.2e-3}};

Grid<float> sum_of(double level, const Grid<double>& texture, double contrast, const Grid<double>& noise,
                   double deviation) {
    Grid<float> image(texture.columns, texture.rows);
    for (std::size_t k = 0; k < image.values.size(); ++k) {
        image.values[k] = static_cast<float>(level + contrast * texture.values[k] + deviation * noise.values[k]);
    }
    return image;
}

TEST(NoiseGain, OfIndependentPixelsIsThatOfClosedForms) {
    EXPECT_NEAR(noise_gain(FocusMeasure::standard_deviation, 49), 1 / 7.0, 1e-15);
    EXPECT_NEAR(noise_gain(FocusMeasure::tenengrad, 49), std::sqrt(130.0 / 3) / 7, 1e-12);
    EXPECT_NEAR(noise_gain(FocusMeasure::brenner, 49), std::sqrt(5.0) / 7, 1e-12);
    EXPECT_NEAR(noise_gain(FocusMeasure::wavelet, 49), std::sqrt(269165.0 / 36096) / 7, 1e-12);
    EXPECT_NEAR(noise_gain(FocusMeasure::modified_laplacian, 1), std::sqrt(27.9), 0.005); // three digits
}

// Standard deviation of the measure of blurred noise over a texture, over that of the gain. At 256 places that share no
// pixel, 8 images of 3 textures: 5376 degrees of freedom, 1 % of a standard deviation.
double measured_over(FocusMeasure measure, const BlurredNoise& texture, const BlurredNoise& noise, double gain) {
    constexpr int side = 432, width = 21, spacing = 27, images = 8;
    constexpr double level = 100, contrast = 10, deviation = 0.2;
    const FocusWindow window(width, WindowShape::box);
    double variance = 0, places = 0;
    for (unsigned seed = 0; seed < 3; ++seed) {
        std::mt19937_64 random(seed);
        const auto below = texture.image(random);
        std::vector<Grid<float>> measures;
        for (int k = 0; k < images; ++k) {
            measures.push_back(
                focus_measure({sum_of(level, below, contrast, noise.image(random), deviation)}, measure, window));
        }
        for (int row = spacing / 2; row < side; row += spacing) {
            for (int column = spacing / 2; column < side; column += spacing) {
                double sum = 0, squares = 0;
                for (const auto& values : measures) {
                    sum += values(column, row);
                    squares += std::pow(values(column, row), 2);
                }
                variance += (squares - sum * sum / images) / (images - 1);
                places += 1;
            }
        }
    }
    return std::sqrt(variance / places) / (gain / width * deviation / level);
}

TEST(NoiseGain, OfBlurredNoiseIsThatOfItsImages) {
    for (const auto& [aperture, pitch] : blurs) {
        const auto blurred = test::blurred_by_pupil(432, aperture, pitch);
        for (const auto& name : focus_measure_names()) {
            const auto measure = focus_measure_from_name(name);
            const double ratio =
                measured_over(measure, blurred, blurred, noise_gain(measure, 1, blurred.correlation()));
            // Four standard deviations; a window of 21 has a tenth less at most, as for independent noise.
            EXPECT_LT(ratio, 1.04) << name << " " << aperture;
            EXPECT_GT(ratio, 0.89) << name << " " << aperture;
            RecordProperty(name + std::to_string(aperture), std::to_string(ratio));
        }
        // Noise of the pupil's parts is less blurred than the texture.
        const auto parts = test::blurred_by_parts(432, aperture, pitch);
        for (const auto measure : {FocusMeasure::wavelet, FocusMeasure::modified_laplacian}) {
            const double ratio = measured_over(measure, blurred, parts, noise_gain(measure, 1, parts.correlation()));
            EXPECT_NEAR(ratio, 1, 0.1) << name_of(measure) << " " << aperture;
            RecordProperty("parts" + name_of(measure) + std::to_string(aperture), std::to_string(ratio));
        }
        // The wrong twin: independent pixels.
        const double twin = measured_over(FocusMeasure::wavelet, blurred, parts, noise_gain(FocusMeasure::wavelet, 1));
        EXPECT_LT(twin, 0.7) << aperture;
        RecordProperty("twin" + std::to_string(aperture), std::to_string(twin));
    }
}

// Level, in focus at image 20 everywhere; a texture fades as a Gaussian of a standard deviation of 5 images.
class LevelStack {
  public:
    LevelStack(const Grid<double>& texture, const BlurredNoise& noise, unsigned seed)
        : noise_(noise), random_(seed), texture_(texture) {}

    static constexpr int images = 41;
    Grid<float> image(int k) {
        return sum_of(100, texture_, 10 * std::exp(-0.5 * std::pow((k - 20) / 5.0, 2)), noise_.image(random_), 1);
    }
    Topography evaluated(FocusMeasure measure) {
        std::vector<Grid<float>> stack;
        std::vector<double> z;
        for (int k = 0; k < images; ++k) {
            stack.push_back(image(k));
            z.push_back(k);
        }
        return reconstruct(stack, z, 0, 0, 1, {.focus_measure = measure, .smoothing_steps = 2});
    }

  private:
    const BlurredNoise& noise_;
    std::mt19937_64 random_;
    const Grid<double>& texture_;
};

TEST(NoiseCorrelation, IsFoundInTheStack) {
    constexpr int side = 128;
    for (const auto& [aperture, pitch] : blurs) {
        const auto texture = test::blurred_by_pupil(side, aperture, pitch);
        const auto noise = test::blurred_by_parts(side, aperture, pitch);
        std::mt19937_64 random(4);
        const auto below = texture.image(random);
        LevelStack stack(below, noise, 5);
        FocusProbes probes(side, side, FocusMeasure::wavelet, FocusWindow(7, WindowShape::box));
        for (int k = 0; k < LevelStack::images; ++k) {
            probes.add({stack.image(k)});
        }
        const auto found = probes.noise_correlation(), expected = noise.correlation();
        for (int dy = 0; dy <= NoiseCorrelation::reach; ++dy) {
            for (int dx = -NoiseCorrelation::reach; dx <= NoiseCorrelation::reach; ++dx) {
                // Four of some 240 000 pairs' deviations are 0.012; of a patch's variance the smallest quarter is
                // taken.
                EXPECT_NEAR(found(dx, dy), expected(dx, dy), 0.03) << aperture << " " << dx << " " << dy;
            }
        }
    }
}

TEST(NoiseCorrelation, IsNoneOfIndependentNoiseNorOfFewImages) {
    constexpr int side = 96;
    const auto texture = test::blurred_by_pupil(side, 0.28, 0.5e-3);
    const BlurredNoise white(side, 1, 0.1, [](double, double) { return 1; });
    std::mt19937_64 random(4);
    const auto below = texture.image(random);
    const auto found_in = [&](const BlurredNoise& noise, int images) {
        LevelStack stack(below, noise, 6);
        FocusProbes probes(side, side, FocusMeasure::wavelet, FocusWindow(7, WindowShape::box));
        for (int k = 0; k < images; ++k) {
            probes.add({stack.image(k)});
        }
        return probes.noise_correlation();
    };
    const auto independent = found_in(white, LevelStack::images), few = found_in(texture, 9);
    for (int dy = -NoiseCorrelation::reach; dy <= NoiseCorrelation::reach; ++dy) {
        for (int dx = -NoiseCorrelation::reach; dx <= NoiseCorrelation::reach; ++dx) {
            EXPECT_EQ(independent(dx, dy), dx == 0 && dy == 0 ? 1 : 0);
            EXPECT_EQ(few(dx, dy), dx == 0 && dy == 0 ? 1 : 0);
        }
    }
}

// Of 12 stacks that differ in their noise, against the map that each of them is given. A hundred windows that share no
// pixel have 11 degrees of freedom each: a standard deviation known to 2 %.
TEST(HeightNoise, OfBlurredImagesIsThatOfTheirHeights) {
    constexpr int side = 96, stacks = 12;
    for (const auto& [aperture, pitch] : blurs) {
        const auto texture = test::blurred_by_pupil(side, aperture, pitch);
        const auto noise = test::blurred_by_parts(side, aperture, pitch);
        for (const auto measure : {FocusMeasure::wavelet, FocusMeasure::modified_laplacian}) {
            Grid<double> sums(side, side), squares = sums, counts = sums;
            double told = 0, points = 0;
            std::mt19937_64 random(3);
            const auto below = texture.image(random);
            for (unsigned seed = 0; seed < stacks; ++seed) {
                LevelStack stack(below, noise, seed);
                const auto topography = stack.evaluated(measure);
                for (std::size_t k = 0; k < sums.values.size(); ++k) {
                    const double height = topography.height.height.values[k];
                    if (std::isfinite(height)) {
                        sums.values[k] += height;
                        squares.values[k] += height * height;
                        counts.values[k] += 1;
                        told += std::pow(topography.height_noise.values[k], 2);
                        points += 1;
                    }
                }
            }
            double variance = 0, places = 0;
            for (std::size_t k = 0; k < sums.values.size(); ++k) {
                if (counts.values[k] == stacks) {
                    variance += (squares.values[k] - sums.values[k] * sums.values[k] / stacks) / (stacks - 1);
                    places += 1;
                }
            }
            const double ratio = std::sqrt(told / points) / std::sqrt(variance / places);
            EXPECT_GT(places, 0.95 * side * side);
            EXPECT_NEAR(ratio, 1, 0.15) << name_of(measure) << " " << aperture;
            RecordProperty(name_of(measure) + std::to_string(aperture), std::to_string(ratio));
        }
    }
}

} // namespace
} // namespace vkfv::topography
