#include "topography/stack_faults.hpp"

#include "core/mathematics/units.hpp"
#include "topography/model_stack.hpp"
#include "topography/topography.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace vkfv::topography {
namespace {

using test::side;

StackFaults faults_of(const std::vector<Grid<float>>& images) {
    StackFaultsFinder finder(static_cast<int>(images.size()));
    for (const auto& image : images) {
        finder.add({image});
    }
    return finder.finish();
}

// Images with texture that is in focus in the middle, and noise of 1 % of the brightness.
std::vector<Grid<float>> good_images(unsigned seed) {
    auto images = test::model_stack(41, 4, false, seed).images;
    std::mt19937 random(seed + 100);
    std::normal_distribution<double> normal;
    for (auto& image : images) {
        for (float& value : image.values) {
            value += static_cast<float>(1.2 * normal(random));
        }
    }
    return images;
}

void brighten(Grid<float>& image, double times) {
    for (float& value : image.values) {
        value *= static_cast<float>(times);
    }
}

TEST(StackFaults, GoodImagesHaveNone) {
    const StackFaults faults = faults_of(good_images(1));
    EXPECT_LT(faults.flicker, 0.002);
    EXPECT_EQ(faults.exposure_step, 0);
    EXPECT_EQ(faults.saturated_share, 0);
    EXPECT_LT(faults.wander, 0.5);
    EXPECT_LT(faults.corner_wander, 0.5);
}

TEST(StackFaults, FlickerIsTold) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    constexpr int stacks = 12;
    double mean = 0;
    for (unsigned seed = 0; seed < stacks; ++seed) {
        auto images = good_images(seed);
        for (auto& image : images) {
            brighten(image, 1 + 0.05 * normal(random));
        }
        const StackFaults faults = faults_of(images);
        EXPECT_EQ(faults.exposure_step, 0) << seed;
        mean += faults.flicker / stacks;
    }
    // The median of 39 second differences of independent normal values has a mean of 1.017 and a standard deviation of
    // 0.224 of what it estimates, by 200 000 simulated stacks in numpy.
    EXPECT_NEAR(mean, 1.017 * 0.05, 3 * 0.224 * 0.05 / std::sqrt(stacks));
}

TEST(StackFaults, AStepOfTheExposureIsToldWithItsPlace) {
    auto images = good_images(4);
    for (std::size_t k = 25; k < images.size(); ++k) {
        brighten(images[k], 1.2);
    }
    const StackFaults faults = faults_of(images);
    EXPECT_NEAR(faults.exposure_step, 0.2 / (1 + 0.2 * 16 / 41), 0.01);
    EXPECT_EQ(faults.step_image, 25);
    EXPECT_LT(faults.flicker, 0.01);
    // The wrong twin is light that changes slowly.
    auto slow = good_images(4);
    for (std::size_t k = 0; k < slow.size(); ++k) {
        brighten(slow[k], 1 + 0.3 * static_cast<double>(k) / 40);
    }
    EXPECT_EQ(faults_of(slow).exposure_step, 0);
}

TEST(StackFaults, SaturatedPixelsAreCounted) {
    auto images = good_images(5);
    std::size_t cut = 0, all = 0;
    for (auto& image : images) {
        for (float& value : image.values) {
            cut += value >= 140 ? 1u : 0u;
            value = std::min(value, 140.0f);
        }
        all += image.values.size();
    }
    ASSERT_GT(cut, all / 100);
    EXPECT_NEAR(faults_of(images).saturated_share, static_cast<double>(cut) / static_cast<double>(all), 1e-12);
}

// Grey values of a Gaussian distribution about 0.45 of full scale, of a contrast, and rounded to a number of levels.
std::vector<float> grey_values(double contrast, double levels) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal(0.45, 0.45 * contrast);
    std::vector<float> values(200'000);
    std::ranges::generate(values, [&] { return static_cast<float>(std::round(normal(random) * levels) / levels); });
    return values;
}

Saturation saturation_of(std::span<const float> values) {
    SaturationCount count;
    count.add(values.subspan(0, values.size() / 3));
    count.add(values.subspan(values.size() / 3));
    return count.found();
}

// Where the texture has little contrast, many grey values lie just below the saturated ones.
TEST(Saturation, IsFoundAtEveryContrastAndDepth) {
    for (const double levels : {255.0, 4095.0, 65535.0}) {
        for (const double contrast : {0.03, 0.1, 0.4}) {
            for (const double share : {0.01, 0.1, 0.3}) {
                auto values = grey_values(contrast, 1e7); // hardly rounded: the camera rounds once, after it saturates
                auto sorted = values;
                std::ranges::sort(sorted);
                const float level = sorted[static_cast<std::size_t>((1 - share) * static_cast<double>(sorted.size()))];
                // A camera saturates at the end of its grey values.
                std::ranges::transform(values, values.begin(), [&](float v) {
                    return static_cast<float>(std::round(std::min(v / level, 1.0f) * levels) / levels);
                });
                const auto there = static_cast<double>(std::ranges::count(values, 1.0f));
                EXPECT_EQ(saturation_of(values).level, 1) << levels << " " << contrast << " " << share;
                EXPECT_EQ(saturation_of(values).share, there / static_cast<double>(values.size()));
            }
        }
    }
}

// Values that only reach the end of the grey levels are unsaturated: a Gaussian tail, the turning points of a grating,
// and levels that a stretched contrast fills twice.
TEST(Saturation, IsNotFoundWhereNoValueIsCutOff) {
    for (const double levels : {255.0, 65535.0}) {
        for (const double contrast : {0.01, 0.03, 0.1, 0.4}) {
            auto values = grey_values(contrast, levels);
            EXPECT_EQ(saturation_of(values).share, 0) << levels << " " << contrast;
            const float largest = std::ranges::max(values);
            std::ranges::transform(values, values.begin(), [&](float v) {
                return static_cast<float>(std::round(v / largest * 0.6 * levels) / (0.6 * levels));
            });
            EXPECT_EQ(saturation_of(values).share, 0) << levels << " " << contrast << ", stretched";
        }
        std::vector<float> grating(200'000);
        for (std::size_t k = 0; k < grating.size(); ++k) {
            const double value = 0.5 + 0.5 * std::sin(0.1 * static_cast<double>(k));
            grating[k] = static_cast<float>(std::round(value * levels) / levels);
        }
        EXPECT_EQ(saturation_of(grating).share, 0) << levels;
    }
    EXPECT_EQ(saturation_of(std::vector<float>(2000, 0.5f)).share, 0); // one value everywhere
}

// Images of spots that every image shows, however far from focus, in noise. `path` gives the shift in pixels and the
// scale of an image by its place in the stack, 0 to 1.
template <typename Path>
StackFaults faults_of_moved(Path path, unsigned seed) {
    std::vector<Grid<float>> images(41, Grid<float>(side, side));
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (auto& image : images) {
        std::ranges::generate(image.values, [&] { return static_cast<float>(120 + normal(random)); });
    }
    std::uniform_real_distribution<double> place(0, side);
    std::vector<std::array<double, 2>> spots(60);
    for (auto& spot : spots) {
        spot = {place(random), place(random)};
    }
    for (std::size_t k = 0; k < images.size(); ++k) {
        const auto [shift, size] = path(static_cast<double>(k) / static_cast<double>(images.size() - 1));
        const double middle = 0.5 * (side - 1);
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                for (const auto& [x, y] : spots) {
                    const double dx = column - (middle + size * (x - middle) + shift);
                    const double dy = row - (middle + size * (y - middle));
                    images[k](column, row) += static_cast<float>(40 * std::exp(-(dx * dx + dy * dy) / 18));
                }
            }
        }
    }
    return faults_of(images);
}

TEST(StackFaults, MovementOfTheImageIsTold) {
    for (const unsigned seed : {11u, 12u, 13u}) {
        EXPECT_LT(faults_of_moved([](double) { return std::pair(0.0, 1.0); }, seed).wander, 0.3);
        const StackFaults shifted = faults_of_moved([](double part) { return std::pair(4 * part, 1.0); }, seed);
        EXPECT_NEAR(shifted.wander, 4, 0.2);
        EXPECT_LT(shifted.corner_wander, 1);
        const StackFaults scaled = faults_of_moved([](double part) { return std::pair(0.0, 1 - 0.06 * part); }, seed);
        EXPECT_NEAR(scaled.scale, 0.94, 0.006);
        EXPECT_NEAR(scaled.corner_wander, 0.06 * 0.5 * std::sqrt(2.0) * side, 0.5);
    }
}

TEST(StackFaults, MovementBackAndForthIsTold) {
    for (const unsigned seed : {11u, 12u, 13u}) {
        // The stage swings by 3 pixels to either side and ends where it began.
        const StackFaults swung =
            faults_of_moved([](double part) { return std::pair(3 * std::sin(2 * pi * part), 1.0); }, seed);
        EXPECT_NEAR(swung.wander, 6, 0.3);
        const StackFaults breathed =
            faults_of_moved([](double part) { return std::pair(0.0, 1 + 0.05 * std::sin(pi * part)); }, seed);
        EXPECT_NEAR(std::abs(breathed.scale - 1), 0.05, 0.006);
    }
}

TEST(StackFaults, ImagesWithoutTextureDoNotMove) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::vector<Grid<float>> images(41, Grid<float>(side, side));
    for (auto& image : images) {
        std::ranges::generate(image.values, [&] { return static_cast<float>(100 + normal(random)); });
    }
    const StackFaults faults = faults_of(images);
    EXPECT_LT(faults.wander, 1);
    EXPECT_LT(faults.corner_wander, 1);
}

double median_noise(const std::vector<Grid<float>>& images) {
    std::vector<double> z;
    for (std::size_t k = 0; k < images.size(); ++k) {
        z.push_back(static_cast<double>(k));
    }
    const Topography topography = reconstruct(images, z, 0, 0, 1, {});
    std::vector<double> noise;
    std::ranges::copy_if(topography.height_noise.values, std::back_inserter(noise),
                         [](double value) { return std::isfinite(value); });
    EXPECT_GT(noise.size(), topography.height_noise.values.size() / 2);
    std::ranges::nth_element(noise, noise.begin() + static_cast<std::ptrdiff_t>(noise.size() / 2));
    return noise[noise.size() / 2];
}

TEST(StackFaults, FlickerIsNoNoise) {
    const double steady = median_noise(good_images(8));
    auto images = good_images(8);
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    for (auto& image : images) {
        brighten(image, 1 + 0.05 * normal(random));
    }
    EXPECT_NEAR(median_noise(images) / steady, 1, 0.15);
}

TEST(StackFaults, SaturatedPixelsHideNoNoise) {
    const double whole = median_noise(good_images(10));
    auto images = good_images(10);
    for (auto& image : images) {
        for (int row = 0; row < side / 3; ++row) {
            for (int column = 0; column < side / 3; ++column) {
                image(column, row) = 255; // a highlight over a ninth of the image
            }
        }
    }
    EXPECT_NEAR(median_noise(images) / whole, 1, 0.15); // the tolerance of flicker
}

} // namespace
} // namespace vkfv::topography
