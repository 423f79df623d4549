// The errors of a stage move heights, by the peak fit that evaluations use, as closed forms say. The focus curve is a
// Gaussian of standard deviation w around the surface; least squares weighs what an image says of its place by the
// square of the curve's slope, u^2 exp(-u^2) with u = z / w:
//   jitter:  sigma sqrt(D / w) sqrt(integral u^4 exp(-2 u^2) du) / integral u^2 exp(-u^2) du  = 0.547 sigma sqrt(D / w)
//   noise:   (sigma_F / A) sqrt(w D / integral u^2 exp(-u^2) du)                    = 1.062 (sigma_F / A) sqrt(w D)
//   a sine of a rad/mm along z:  (1 - (a w)^2 / 2) exp(-(a w)^2 / 4) of its amplitude
#include "core/mathematics/units.hpp"
#include "focus/focus.hpp"
#include "scan/stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace vkfv::measurement {
namespace {

using namespace focus::f64;

constexpr double step = 0.0005;      // mm
constexpr double width = 4.3 * step; // of the focus curve
constexpr int images = 2001;
constexpr int range = 16; // steps on either side of the peak

struct Curve {
    std::vector<double> values;
    double curve_value(int image) const { return values.at(static_cast<std::size_t>(image)); }
};

std::vector<double> positions() {
    std::vector<double> result;
    for (int image = 0; image < images; ++image) {
        result.push_back(step * (image - images / 2));
    }
    return result;
}

// The height that is told of a surface at `height`; `noise` is that of each value of the curve, whose maximum is 1.
double measured(const scan::StageMotion& motion, double height, double noise, std::mt19937& random) {
    std::normal_distribution<double> normal;
    const auto nominal = positions();
    Curve curve;
    const int nearest = static_cast<int>(std::lround(height / step)) + images / 2;
    const int first = nearest - 2 * range;
    int largest = 0;
    for (int k = 0; k <= 4 * range; ++k) {
        const int image = first + k;
        const double z =
            motion.at(nominal.at(static_cast<std::size_t>(image)), static_cast<std::uint32_t>(image)).height;
        curve.values.push_back(std::exp(-0.5 * std::pow((z - height) / width, 2)) + noise * normal(random));
        largest = curve.values.back() > curve.values[static_cast<std::size_t>(largest)] ? k : largest;
    }
    FocusPlan plan{};
    plan.peak = PEAK_GAUSSIAN_FIT;
    plan.peak_range = range;
    const PeakFit fit = locate_peak(curve, plan, largest, range);
    EXPECT_EQ(fit.found, 1);
    return nominal.at(static_cast<std::size_t>(first + largest)) + step * fit.offset;
}

// The standard deviation of the heights' errors over a slope, at points farther apart than a curve is wide, and over
// ten seeds.
double height_noise(scan::Stage stage, double noise) {
    std::mt19937 random(7);
    double squares = 0;
    int count = 0;
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        stage.seed = seed;
        const scan::StageMotion motion(stage, positions());
        for (double height = -0.45; height < 0.45; height += 6.37 * step) {
            squares += std::pow(measured(motion, height, noise, random) - height, 2);
            ++count;
        }
    }
    return std::sqrt(squares / count);
}

} // namespace

TEST(StageErrors, OfTheScaleAreThoseOfHeights) {
    std::mt19937 random(1);
    scan::Stage stage;
    stage.scale_error = 0.013;
    const scan::StageMotion motion(stage, positions());
    for (const double height : {-0.2, -0.03, 0.1, 0.4}) {
        EXPECT_NEAR(measured(motion, height, 0, random), 1.013 * height, 1e-9);
    }
}

// The statistical error of 2800 heights is 1.3 %.
TEST(StageErrors, JitterMovesHeightsAsLeastSquaresSays) {
    scan::Stage stage;
    stage.jitter = 0.1 * step;
    EXPECT_NEAR(height_noise(stage, 0) / (0.547 * stage.jitter * std::sqrt(step / width)), 1, 0.05);
    stage.jitter *= 4;
    EXPECT_NEAR(height_noise(stage, 0) / (0.547 * stage.jitter * std::sqrt(step / width)), 1, 0.08);
}

TEST(StageErrors, NoiseOfTheFocusValueMovesHeightsAsLeastSquaresSays) {
    EXPECT_NEAR(height_noise({}, 0.003) / (1.062 * 0.003 * std::sqrt(width * step)), 1, 0.05);
}

// On a slope a vibration is seen as a ripple of its aliased frequency, whatever its phase: ten seeds give ten phases.
class Ripple : public testing::TestWithParam<std::uint32_t> {};

TEST_P(Ripple, OfAVibrationHasItsAliasedFrequency) {
    std::mt19937 random(1);
    scan::Stage stage;
    stage.seed = GetParam();
    stage.interval = 0.01;
    const double remaining = 3; // Hz, of 203 Hz looked at 100 times a second
    stage.vibrations = {{.amplitude = 0.05 * step, .frequency = 203}};
    const scan::StageMotion motion(stage, positions());
    const double angular = 2 * pi * remaining * stage.interval / step; // rad/mm
    std::vector<double> errors;
    double cosine = 0, sine = 0;
    constexpr int points = 1500;
    const double period = 2 * pi / angular;
    for (int k = 0; k < points; ++k) {
        const double height = -20 * period + 40 * period * k / points;
        const double error = measured(motion, height, 0, random) - height;
        errors.push_back(error);
        cosine += error * std::cos(angular * height) * 2 / points;
        sine += error * std::sin(angular * height) * 2 / points;
    }
    const double x = angular * width;
    const double expected = stage.vibrations[0].amplitude * (1 - x * x / 2) * std::exp(-x * x / 4);
    EXPECT_NEAR(std::hypot(cosine, sine), std::abs(expected), 0.03 * stage.vibrations[0].amplitude);
    double rest = 0; // beside the ripple
    for (const double error : errors) {
        rest += error * error / points;
    }
    EXPECT_NEAR(rest, 0.5 * (cosine * cosine + sine * sine), 0.1 * rest);
}

INSTANTIATE_TEST_SUITE_P(StageErrors, Ripple, testing::Range(1u, 11u));

} // namespace vkfv::measurement
