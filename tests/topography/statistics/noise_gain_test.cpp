// Noise of focus measures and of heights is known where neighbouring pixels' noise is correlated.
#include "topography/noise/noise_gain.hpp"

#include "topography/blurred_noise.hpp"
#include "topography/topography.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace vkfv::topography {
namespace {

using test::BlurredNoise;

struct Blur {
    double aperture, pitch; // mm
};
constexpr std::array blurs = {Blur{0.28, 1e-3}, Blur{0.41, 0.5e-3}, Blur{0.66, 0.2e-3}};

constexpr int image_side = 243;

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
    EXPECT_NEAR(noise_gain(FocusMeasure::gradient_and_curvature, 49), std::sqrt(419.0 / 5) / 7, 1e-12);
    EXPECT_NEAR(noise_gain(FocusMeasure::modified_laplacian, 1), std::sqrt(27.9), 0.005); // three digits
}

// The standard deviation of the measures (by number) of blurred noise of relative deviation 1 over a texture, in a
// window of a pixel. 81 places that share no pixel and 6 images of 4 textures have 1620 degrees of freedom: 1.8 % of
// the deviation.
std::vector<double> gains_of_images(const std::vector<FocusMeasure>& measures, const BlurredNoise& texture,
                                    const BlurredNoise& noise) {
    constexpr int width = 21, spacing = 27, images = 6, textures = 4;
    constexpr double level = 100, contrast = 10, deviation = 0.2;
    const FocusWindow window(width, WindowShape::box);
    std::vector<double> variances(measures.size());
    double places = 0;
    for (unsigned seed = 0; seed < textures; ++seed) {
        std::mt19937_64 random(seed);
        const auto below = texture.image(random);
        std::vector<Grid<float>> stack;
        for (int k = 0; k < images; ++k) {
            stack.push_back(sum_of(level, below, contrast, noise.image(random), deviation));
        }
        for (std::size_t m = 0; m < measures.size(); ++m) {
            std::vector<Grid<float>> values;
            for (const auto& image : stack) {
                values.push_back(focus_measure({image}, measures[m], window));
            }
            for (int row = spacing / 2; row < image_side; row += spacing) {
                for (int column = spacing / 2; column < image_side; column += spacing) {
                    double sum = 0, squares = 0;
                    for (const auto& value : values) {
                        sum += value(column, row);
                        squares += std::pow(value(column, row), 2);
                    }
                    variances[m] += (squares - sum * sum / images) / (images - 1);
                    places += m == 0 ? 1 : 0;
                }
            }
        }
    }
    for (double& variance : variances) {
        variance = std::sqrt(variance / places) * width * level / deviation;
    }
    return variances;
}

TEST(NoiseGain, OfBlurredNoiseIsThatOfItsImages) {
    using enum FocusMeasure;
    const std::vector<FocusMeasure> all = {standard_deviation,    tenengrad, modified_laplacian, brenner, wavelet,
                                           gradient_and_curvature};
    for (const auto& [aperture, pitch] : blurs) {
        const auto blurred = test::blurred_by_pupil(image_side, aperture, pitch);
        const auto gains = gains_of_images(all, blurred, blurred);
        for (std::size_t m = 0; m < all.size(); ++m) {
            const double ratio = gains[m] / noise_gain(all[m], 1, blurred.correlation());
            // The bounds are four standard deviations; a window of 21 has a tenth less at most, as for independent
            // noise.
            EXPECT_LT(ratio, 1.07) << name_of(all[m]) << " " << aperture;
            EXPECT_GT(ratio, 0.88) << name_of(all[m]) << " " << aperture;
        }
        // Noise of the pupil's parts is less blurred than the texture.
        const auto parts = test::blurred_by_parts(image_side, aperture, pitch);
        const std::vector<FocusMeasure> second = {modified_laplacian, wavelet};
        const auto of_parts = gains_of_images(second, blurred, parts);
        for (std::size_t m = 0; m < second.size(); ++m) {
            const double ratio = of_parts[m] / noise_gain(second[m], 1, parts.correlation());
            EXPECT_LT(ratio, 1.07) << name_of(second[m]) << " " << aperture;
            EXPECT_GT(ratio, 0.88) << name_of(second[m]) << " " << aperture;
        }
        // The wrong twin is noise of independent pixels.
        EXPECT_LT(of_parts[1] / noise_gain(wavelet, 1), 0.7) << aperture;
    }
}

// A level stack, in focus at image 20 everywhere; its texture fades as a Gaussian of a standard deviation of 5 images.
class LevelStack {
  public:
    LevelStack(const Grid<double>& texture, const BlurredNoise& noise, unsigned seed, double deviation = 1)
        : noise_(noise), random_(seed), texture_(texture), deviation_(deviation) {}

    static constexpr int images = 41;
    Grid<float> image(int k) {
        return sum_of(100, texture_, 10 * std::exp(-0.5 * std::pow((k - 20) / 5.0, 2)), noise_.image(random_),
                      deviation_);
    }
    Topography evaluated(FocusMeasure measure, double smoothing_steps = 2) {
        std::vector<Grid<float>> stack;
        std::vector<double> z;
        for (int k = 0; k < images; ++k) {
            stack.push_back(image(k));
            z.push_back(k);
        }
        return reconstruct(
            stack, z, 0, 0, 1,
            {.focus_measure = measure, .smoothing_steps = smoothing_steps, .false_peak_rate = 1, .most_rival = 1});
    }

  private:
    const BlurredNoise& noise_;
    std::mt19937_64 random_;
    const Grid<double>& texture_;
    double deviation_;
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
                // Four deviations of some 240 000 pairs are 0.012; of a patch's variance the smallest quarter is taken.
                EXPECT_NEAR(found(dx, dy), expected(dx, dy), 0.03) << aperture << " " << dx << " " << dy;
            }
        }
    }
}

TEST(NoiseCorrelation, IsNoneOfIndependentNoiseNorOfFewImages) {
    constexpr int side = 96;
    const auto texture = test::blurred_by_pupil(side, 0.28, 0.5e-3);
    const BlurredNoise white(side);
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

struct Scatter {
    double told_over_found = 0;
    double share = 0; // of the points that every stack measured
};

// The noise that each map is given, over the scatter of heights over stacks that differ in their noise; both are root
// mean squares over the points.
Scatter scatter_of(const Grid<double>& texture, const BlurredNoise& noise, FocusMeasure measure, double smoothing_steps,
                   unsigned stacks) {
    Grid<double> sums(texture.columns, texture.rows), squares = sums, counts = sums;
    double told = 0, points = 0;
    for (unsigned seed = 0; seed < stacks; ++seed) {
        LevelStack stack(texture, noise, seed);
        const auto topography = stack.evaluated(measure, smoothing_steps);
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
    return {.told_over_found = std::sqrt(told / points) / std::sqrt(variance / places),
            .share = places / static_cast<double>(sums.values.size())};
}

// The 81 windows share no pixel and have 9 degrees of freedom each: a standard deviation is known to 2.6 %.
TEST(HeightNoise, OfBlurredImagesIsThatOfTheirHeights) {
    constexpr int side = 64, stacks = 10;
    for (const auto& [aperture, pitch] : blurs) {
        const auto texture = test::blurred_by_pupil(side, aperture, pitch);
        const auto noise = test::blurred_by_parts(side, aperture, pitch);
        for (const auto measure : {FocusMeasure::wavelet, FocusMeasure::modified_laplacian}) {
            std::mt19937_64 random(3);
            const auto found = scatter_of(texture.image(random), noise, measure, 2, stacks);
            EXPECT_GT(found.share, 0.95);
            RecordProperty(name_of(measure) + std::to_string(aperture), std::to_string(found.told_over_found));
            EXPECT_NEAR(found.told_over_found, 1, 0.15) << name_of(measure) << " " << aperture;
        }
    }
}

// The noise of a camera arises after the blur, so that its spectrum is not that of the texture. The 81 windows have 19
// degrees of freedom each: a standard deviation is known to 1.8 %.
TEST(HeightNoise, OfACameraIsThatOfItsHeights) {
    constexpr int side = 64;
    constexpr unsigned stacks = 20;
    constexpr double aperture = 0.41, nyquist = 0.55e-3 / (4 * aperture);
    struct Case {
        FocusMeasure measure;
        double pitch; // over that of Nyquist
        double smoothing_steps;
    };
    using enum FocusMeasure;
    const BlurredNoise noise(side);
    for (const auto& [measure, pitch, smoothing_steps] :
         {Case{wavelet, 1, 2}, Case{wavelet, 1, 0}, Case{tenengrad, 0.5, 2}, Case{gradient_and_curvature, 1, 2},
          Case{gradient_and_curvature, 0.5, 2}, Case{gradient_and_curvature, 0.5, 0}}) {
        std::mt19937_64 random(3);
        const auto texture = test::blurred_by_pupil(side, aperture, pitch * nyquist).image(random);
        const auto found = scatter_of(texture, noise, measure, smoothing_steps, stacks);
        const std::string name = name_of(measure) + " " + std::to_string(pitch) + " " + std::to_string(smoothing_steps);
        EXPECT_GT(found.share, 0.95) << name;
        EXPECT_NEAR(found.told_over_found, 1, 0.15) << name;

        // The wrong twin assumes a texture with the same spectrum as the noise.
        LevelStack stack(texture, noise, 0);
        FocusProbes probes(side, side, measure, FocusWindow(7, WindowShape::box));
        for (int k = 0; k < LevelStack::images; ++k) {
            probes.add({stack.image(k)});
        }
        const auto beside = probes.texture_and_noise(axial_weights(smoothing_steps), probes.noise(), {});
        ASSERT_TRUE(beside);
        const double twin = noise_gain(measure, 49) / std::sqrt(beside->beside[0]);
        EXPECT_GT(found.told_over_found * twin, 1.15) << name;
    }
}

TEST(FocusChoice, IsByTheNoiseOfTheStack) {
    constexpr int side = 96;
    constexpr double aperture = 0.41, nyquist = 0.55e-3 / (4 * aperture);
    std::mt19937_64 random(3);
    const auto texture = test::blurred_by_pupil(side, aperture, nyquist).image(random);
    const BlurredNoise noise(side);
    const FocusWindow window(7, WindowShape::box);
    for (const double deviation : {0.0, 0.02, 0.7, 3.0}) { // deviation of the noise; that of the texture is 10
        LevelStack stack(texture, noise, 2, deviation);
        FocusProbes probes(side, side, where_noise_is_low, window), by_chosen(side, side, where_noise_counts, window);
        for (int k = 0; k < LevelStack::images; ++k) {
            const auto image = stack.image(k);
            probes.add({image});
            by_chosen.add({image});
        }
        TopographyOptions options{.focus_measure = std::nullopt};
        EXPECT_FALSE(options.settled());
        const double fine = probes.suitable_smoothing();
        probes.settle(options);
        ASSERT_TRUE(options.settled());
        const bool counts = deviation > 0.1;
        EXPECT_EQ(*options.focus_measure, counts ? where_noise_counts : where_noise_is_low) << deviation;
        // The average along z is chosen for the measure chosen.
        EXPECT_EQ(*options.smoothing_steps, counts ? by_chosen.suitable_smoothing() : fine) << deviation;
        TopographyOptions single{.focus_measure = std::nullopt, .smoothing_steps = 0};
        probes.settle(single);
        EXPECT_EQ(*single.focus_measure, where_little_is_averaged);
        TopographyOptions given{.focus_measure = FocusMeasure::brenner, .smoothing_steps = 3};
        probes.settle(given);
        EXPECT_EQ(*given.focus_measure, FocusMeasure::brenner);
        EXPECT_EQ(*given.smoothing_steps, 3);
    }
}

} // namespace
} // namespace vkfv::topography
