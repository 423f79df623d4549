// Noise that changes along z is not measured: without texture, beside texture, and with a pattern that all images have.
#include "core/mathematics/units.hpp"
#include "topography/persistence.hpp"
#include "topography/topography.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr int side = 64;

using Profile = std::function<double(double)>; // strength of the noise along the scan, which goes from 0 to 1

struct Case {
    std::string name;
    Profile noise;
    int images = 31;
    double deviation = 0.005; // of the noise of strength 1, over the brightness
    double grey_value = 0;    // over the brightness; 0: values are not rounded
    double pattern = 0;       // standard deviation of what all images have, over the brightness
    double quantum = 0;       // step of the coefficients of compressed blocks, over the brightness; 0: not compressed
};

// Blocks of 8 x 8 values, each rounded to multiples of a step in the coefficients of its cosine transform, as JPEG
// does (ITU-T T.81, A.3.3 and A.3.4). The step grows with the frequency.
void compress(Grid<float>& image, double quantum) {
    constexpr int block = 8;
    Grid<double> cosine(block, block); // by place and order
    for (int order = 0; order < block; ++order) {
        for (int place = 0; place < block; ++place) {
            cosine(place, order) =
                std::cos((2 * place + 1) * order * pi / (2 * block)) * std::sqrt((order == 0 ? 1.0 : 2.0) / block);
        }
    }
    for (int top = 0; top < side; top += block) {
        for (int left = 0; left < side; left += block) {
            Grid<double> values(block, block);
            for (int v = 0; v < block; ++v) {
                for (int u = 0; u < block; ++u) {
                    double coefficient = 0;
                    for (int y = 0; y < block; ++y) {
                        for (int x = 0; x < block; ++x) {
                            coefficient += cosine(x, u) * cosine(y, v) * image(left + x, top + y);
                        }
                    }
                    const double step = quantum * (1 + 0.3 * (u + v));
                    coefficient = step * std::round(coefficient / step);
                    for (int y = 0; coefficient != 0 && y < block; ++y) {
                        for (int x = 0; x < block; ++x) {
                            values(x, y) += cosine(x, u) * cosine(y, v) * coefficient;
                        }
                    }
                }
            }
            for (int y = 0; y < block; ++y) {
                for (int x = 0; x < block; ++x) {
                    image(left + x, top + y) = static_cast<float>(values(x, y));
                }
            }
        }
    }
}

double bell(double at, double middle, double width) {
    return 1 + 3 * std::exp(-0.5 * std::pow((at - middle) / width, 2));
}

std::vector<Case> cases() {
    const auto narrow = [](double at) { return bell(at, 0.6, 0.08); };
    const auto wide = [](double at) { return bell(at, 0.5, 0.2); };
    const auto strong = [](double at) { return 1 + 9 * std::exp(-0.5 * std::pow((at - 0.5) / 0.05, 2)); };
    const auto brief = [](double at) { return 1 + 9 * std::exp(-0.5 * std::pow((at - 0.5) / 0.03, 2)); };
    const auto ramp = [](double at) { return 1 + at; };
    const auto step = [](double at) { return at < 0.5 ? 1.0 : 1.6; };
    const auto pulse = [](double at) { return std::abs(at - 0.5) < 0.15 ? 2.0 : 1.0; };
    return {{.name = "narrow bell", .noise = narrow},
            {.name = "wide bell", .noise = wide},
            {.name = "strong bell", .noise = strong},
            {.name = "ramp", .noise = ramp},
            {.name = "step of the gain", .noise = step},
            {.name = "pulse", .noise = pulse},
            {.name = "long scan", .noise = wide, .images = 101, .deviation = 0.003},
            {.name = "few images", .noise = wide, .images = 13},
            {.name = "8 bits", .noise = wide, .deviation = 0.004, .grey_value = 1.0 / 120},
            {.name = "8 bits, little noise", .noise = pulse, .deviation = 0.002, .grey_value = 1.0 / 120},
            {.name = "dust", .noise = wide, .pattern = 0.01},
            {.name = "compressed little", .noise = wide, .grey_value = 1.0 / 120, .quantum = 0.02},
            {.name = "compressed", .noise = strong, .deviation = 0.01, .grey_value = 1.0 / 120, .quantum = 0.065},
            {.name = "compressed much", .noise = strong, .deviation = 0.01, .grey_value = 1.0 / 120, .quantum = 0.13},
            {.name = "an image of noise, compressed",
             .noise = brief,
             .deviation = 0.003,
             .grey_value = 1.0 / 120,
             .quantum = 0.065},
            {.name = "long scan, compressed much",
             .noise = brief,
             .images = 61,
             .deviation = 0.01,
             .grey_value = 1.0 / 120,
             .quantum = 0.13}};
}

// Standard deviation of the texture in focus, over the brightness.
constexpr double object_contrast = 0.1;

// The largest standard deviation of a case's noise along the scan, over the brightness.
double strongest_noise(const Case& of) {
    double strongest = 0;
    for (int image = 0; image < of.images; ++image) {
        strongest = std::max(strongest, of.deviation * of.noise(static_cast<double>(image) / (of.images - 1)));
    }
    return strongest;
}

// Images of brightness 1. With `object` the left half has texture, in focus a little before the middle of the scan.
std::vector<Grid<float>> images_of(const Case& of, bool object, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Grid<double> pattern(side, side), texture(side, side);
    std::ranges::generate(pattern.values, [&] { return normal(random); });
    std::ranges::generate(texture.values, [&] { return normal(random); });
    std::vector<Grid<float>> images;
    for (int image = 0; image < of.images; ++image) {
        const double at = static_cast<double>(image) / (of.images - 1);
        const double contrast = object ? object_contrast * std::exp(-0.5 * std::pow((at - 0.45) / 0.1, 2)) : 0;
        Grid<float>& values = images.emplace_back(side, side);
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                double value = 1 + of.pattern * pattern(column, row) + of.deviation * of.noise(at) * normal(random);
                value += column < side / 2 ? contrast * texture(column, row) : 0;
                values(column, row) = static_cast<float>(value);
            }
        }
        if (of.quantum > 0) {
            compress(values, of.quantum);
        }
        for (float& value : values.values) {
            value = of.grey_value > 0 ? static_cast<float>(std::round(value / of.grey_value) * of.grey_value) : value;
        }
    }
    return images;
}

std::vector<double> steps(int images) {
    std::vector<double> z;
    for (int image = 0; image < images; ++image) {
        z.push_back(image);
    }
    return z;
}

// The share of measured points in the columns from first to end.
double measured_share(const Topography& topography, int first, int end) {
    int measured = 0;
    for (int row = 0; row < side; ++row) {
        for (int column = first; column < end; ++column) {
            measured += topography.state(column, row) == PointState::measured ? 1 : 0;
        }
    }
    return static_cast<double>(measured) / (side * (end - first));
}

TEST(VaryingNoise, IsNotMeasured) {
    for (const Case& one : cases()) {
        SCOPED_TRACE(one.name);
        double share = 0;
        constexpr unsigned seeds = 2;
        for (unsigned seed = 0; seed < seeds; ++seed) {
            const auto images = images_of(one, false, seed);
            share += measured_share(reconstruct(images, steps(one.images), 0, 0, 1, {}), 0, side) / seeds;
        }
        EXPECT_LE(share, 0.005);
    }
}

TEST(VaryingNoise, PassesForTextureWhereItIsTheSameInNeighbouringImages) {
    // The wrong twin is a curve of the same form, whose pattern persists.
    const auto images = images_of({.name = "", .noise = [](double) { return 1.0; }}, true, 5);
    EXPECT_GT(measured_share(reconstruct(images, steps(31), 0, 0, 1, {}), 0, side / 2 - 4), 0.99);
}

TEST(VaryingNoise, BesideAnObjectIsNotMeasuredAndTheObjectIs) {
    constexpr int margin = 6; // pixels whose windows and masks see both
    for (const Case& one : cases()) {
        if (one.images <= few_images) {
            continue; // there a few percent pass by chance, which the command says
        }
        if (strongest_noise(one) > 0.5 * object_contrast) {
            continue; // there noise is a second maximum of the object's own curves
        }
        SCOPED_TRACE(one.name);
        constexpr unsigned seeds = 2;
        double object = 0, blank = 0;
        for (unsigned seed = 0; seed < seeds; ++seed) {
            const Topography topography = reconstruct(images_of(one, true, 7 + seed), steps(one.images), 0, 0, 1, {});
            object += measured_share(topography, 0, side / 2 - margin) / seeds;
            blank += measured_share(topography, side / 2 + margin, side) / seeds;
        }
        EXPECT_GE(object, 0.98);
        EXPECT_LE(blank, 0.005);
    }
}

// Noise whose energies are chi-square variables exceeds the limit as often as its rate says.
TEST(Persistence, TheLimitIsExceededAtItsRate) {
    constexpr int images = 31, degrees = 20, samples = 200000;
    const auto weights = axial_weights(2.0);
    constexpr double rate = 0.05;
    const IndependentImages independent{.mean = 1, .deviation = std::sqrt(2.0 / degrees), .largest = 1};
    const PersistenceLimit limit(independent, weights, true, images, rate);
    double kept = 0;
    for (const Share& share : axial_shares(weights, images / 2, images)) {
        kept += static_cast<double>(share.weight) * static_cast<double>(share.weight);
    }
    std::mt19937 random(1);
    std::chi_squared_distribution<double> chi_square(degrees);
    int exceeded = 0;
    for (int sample = 0; sample < samples; ++sample) {
        focus::f64::CurveRecord curve = focus::f64::empty_curve();
        curve.at = images / 2;
        curve.alone = 1;
        curve.joint = std::sqrt(kept * chi_square(random) / degrees);
        curve.alone_sum = images;
        curve.joint_squares = images * kept;
        exceeded += limit.exceeded_by(curve, 1) ? 1 : 0;
    }
    // A single place of the scan has its share of the rate.
    const double expected = rate / (images * kept) * samples;
    EXPECT_NEAR(exceeded, expected, 0.15 * expected + 4 * std::sqrt(expected));
}

TEST(Persistence, TellsTextureHoweverMuchOfTheScanItFills) {
    const PersistenceLimit limit({.mean = 1, .deviation = 0.3, .largest = 1.8}, {1, 0.5}, false, 9, 0.003);
    focus::f64::CurveRecord curve = focus::f64::empty_curve();
    curve.at = 4;
    curve.largest = curve.alone = curve.joint = 1;
    curve.alone_sum = curve.joint_squares = 9 * 0.9; // a curve far wider than the scan, without noise
    EXPECT_TRUE(limit.exceeded_by(curve, 1));
    curve.joint = std::sqrt(0.375); // noise alone, on a third of the mean
    EXPECT_FALSE(limit.exceeded_by(curve, 1));
}

} // namespace
} // namespace vkfv::topography
