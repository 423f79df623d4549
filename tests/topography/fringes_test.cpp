// Heights by fringes against signals whose height is known.
#include "topography/fringes.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr double step_um = 0.07, first_um = -4;
constexpr int images = 115;

// Fringes of a Gaussian spectrum of wave numbers 2 k about 22.85 rad/um, 1.7 wide, with a phase of their own.
double fringes(double z_um, double height_um, double phase = 0) {
    constexpr double middle = 22.85, deviation = 1.7;
    const double x = z_um - height_um;
    return 1 + 0.8 * std::exp(-std::pow(deviation * x, 2) / 2) * std::cos(middle * x + phase);
}

TopographyOptions options_of(HeightMethod method) {
    TopographyOptions options;
    options.method = method;
    options.least_wave_number = 16e3; // rad/mm
    options.most_wave_number = 30e3;
    return options;
}

// A column of pixels, one for each height, whose values are `of(z, height, pixel)`.
template <class Of>
Topography evaluated(const std::vector<double>& heights_um, HeightMethod method, const Of& of) {
    FringeEvaluator evaluator(options_of(method), {});
    for (int image = 0; image < images; ++image) {
        const double z_um = first_um + step_um * image;
        Grid<float> values(static_cast<int>(heights_um.size()), 1);
        for (std::size_t pixel = 0; pixel < heights_um.size(); ++pixel) {
            values.values[pixel] = static_cast<float>(of(z_um, heights_um[pixel]));
        }
        evaluator.add({values}, from_um(z_um), {});
    }
    return evaluator.finish(0, 0, 1e-3);
}

std::vector<double> some_heights() {
    std::vector<double> heights;
    for (int k = 0; k < 40; ++k) {
        heights.push_back(-1.5 + 0.0771 * k);
    }
    return heights;
}

TEST(Fringes, EnvelopeAndPhaseTellTheHeight) {
    const auto heights = some_heights();
    for (const auto method : {HeightMethod::envelope, HeightMethod::phase}) {
        const auto found = evaluated(heights, method, [](double z, double h) { return fringes(z, h); });
        for (std::size_t k = 0; k < heights.size(); ++k) {
            EXPECT_EQ(found.state.values[k], PointState::measured);
            EXPECT_NEAR(found.height.height.values[k] * um_per_mm, heights[k], 2e-5); // single precision of the images
        }
    }
}

// The phase at the envelope's middle, by the materials of both arms, is the same everywhere: it takes no fringe away.
TEST(Fringes, APhaseOfTheInstrumentMovesNoFringe) {
    const auto heights = some_heights();
    const auto found = evaluated(heights, HeightMethod::phase, [](double z, double h) { return fringes(z, h, 2.9); });
    for (std::size_t k = 1; k < heights.size(); ++k) {
        EXPECT_NEAR((found.height.height.values[k] - found.height.height.values[0]) * um_per_mm,
                    heights[k] - heights[0], 2e-5);
    }
}

// The deviations by noise are those that the evaluation states; the wrong twin states a tenth less.
TEST(Fringes, NoiseIsWhatIsStated) {
    constexpr int points = 2000;
    const std::vector<double> heights(points, 0.123);
    for (const auto method : {HeightMethod::envelope, HeightMethod::phase}) {
        std::mt19937 random(7);
        std::normal_distribution<double> noise(0, 0.02);
        const auto found =
            evaluated(heights, method, [&](double z, double h) { return fringes(z, h) + noise(random); });
        double chi_square = 0;
        for (std::size_t k = 0; k < points; ++k) {
            const double error = found.height.height.values[k] - from_um(heights[k]);
            chi_square += std::pow(error / found.height_noise.values[k], 2);
            EXPECT_GE(found.height_uncertainty.values[k], found.height_noise.values[k]);
        }
        const double limit = 5 * std::sqrt(2.0 * points); // 5 standard deviations of chi-square
        EXPECT_NEAR(chi_square, points, limit);
        EXPECT_GT(std::abs(chi_square / (0.9 * 0.9) - points), limit);
    }
}

TEST(Fringes, WithoutFringesNothingIsMeasured) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 0.1);
    const std::vector<double> heights(1000, 0);
    const auto found = evaluated(heights, HeightMethod::phase, [&](double, double) { return 1 + noise(random); });
    int measured = 0;
    for (const auto state : found.state.values) {
        measured += state == PointState::measured ? 1 : 0;
    }
    EXPECT_LE(measured, 3);
    const auto beyond = evaluated({9.0}, HeightMethod::phase, [](double z, double h) { return fringes(z, h); });
    EXPECT_NE(beyond.state.values.front(), PointState::measured);
}

TEST(Fringes, TooFewImagesAreRefused) {
    FringeEvaluator evaluator(options_of(HeightMethod::phase), {});
    for (int image = 0; image < 5; ++image) {
        evaluator.add({Grid<float>(2, 2, 1)}, from_um(0.07 * image), {});
    }
    EXPECT_THROW((void)evaluator.finish(0, 0, 1e-3), InputError);
    EXPECT_THROW(evaluator.add({Grid<float>(3, 2, 1)}, from_um(1), {}), InputError);
}

} // namespace
} // namespace vkfv::topography
