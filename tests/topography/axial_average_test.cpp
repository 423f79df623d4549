#include "topography/axial_average.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr std::array deviations = {0.0, 0.5, 1.0, 4.0};
constexpr int images = 10;

TEST(AxialAverage, IsTheNormalisedWeightedMeanAlsoAtTheEnds) {
    for (const double s : deviations)
        for (int k = 0; k < images; ++k) {
            const auto shares = axial_shares(axial_weights(s), k, images);
            std::vector<double> expected(images);
            double total = 0;
            for (int i = 0; i < images; ++i) {
                const bool within = i == k || std::abs(i - k) <= std::ceil(3 * s);
                expected[static_cast<std::size_t>(i)] = !within  ? 0
                                                        : i == k ? 1
                                                                 : std::exp(-0.5 * std::pow((i - k) / s, 2));
                total += expected[static_cast<std::size_t>(i)];
            }
            for (const Share& share : shares) {
                double& of_image = expected[static_cast<std::size_t>(share.image)];
                EXPECT_NEAR(share.weight, of_image / total, 6e-8); // float32 of a number below 1
                of_image = 0;
            }
            for (const double left_out : expected)
                EXPECT_EQ(left_out, 0);
        }
}

TEST(AxialAverage, EvenSharesHaveTheSameNoiseEverywhere) {
    for (const double s : {0.3, 0.5, 1.0, 4.0}) {
        const auto weights = axial_weights(s);
        for (const int count : {5, 10, 60}) {
            double before = -1, middle = 0;
            for (const Share& share : even_shares(weights, count / 2, count))
                middle += share.weight * share.weight;
            for (int k = 0; k < count; ++k) {
                double total = 0, variance = 0, place = 0;
                for (const Share& share : even_shares(weights, k, count)) {
                    total += share.weight;
                    variance += share.weight * share.weight;
                    place += share.weight * static_cast<double>(share.image);
                }
                EXPECT_NEAR(total, 1, 1e-6);
                // In a shorter stack the middle, after which the other images are made alike, may lie between two
                // images.
                const bool whole = 2 * weights.size() - 1 <= static_cast<std::size_t>(count);
                EXPECT_NEAR(variance / middle, 1, whole ? 1e-5 : 0.1) << s << " " << count << " " << k;
                EXPECT_GT(place, before) << s << " " << count << " " << k;
                before = place;
            }
        }
    }
}

TEST(AxialAverage, PositionsAreWhatTheAveragesMakeOfAStraightLine) {
    for (const double s : deviations) {
        const auto weights = axial_weights(s);
        std::vector<double> line(images);
        std::iota(line.begin(), line.end(), 0);
        for (int average = 0; average < 2; ++average) {
            const auto before = line;
            for (int k = 0; k < images; ++k) {
                line[static_cast<std::size_t>(k)] = 0;
                for (const Share& share : axial_shares(weights, k, images))
                    line[static_cast<std::size_t>(k)] += share.weight * before[static_cast<std::size_t>(share.image)];
            }
        }
        const auto points = averaged_points(weights, images);
        for (int k = 0; k < images; ++k)
            EXPECT_NEAR(points[static_cast<std::size_t>(k)].position, line[static_cast<std::size_t>(k)], 1e-5)
                << s;                                 // float32
        EXPECT_EQ(points[0].position > 0.5, s > 0.5); // further inside, unless hardly anything is averaged
    }
    const auto far = averaged_points(axial_weights(2), 60);
    for (int k = 12; k < 48; ++k)
        EXPECT_EQ(far[static_cast<std::size_t>(k)].position, k);
}

// The variances are those of white noise, averaged as images and then as a curve that is linear in it.
TEST(AxialAverage, VariancesAreThoseOfAveragedNoise) {
    constexpr int trials = 40000;
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (const double s : {0.0, 1.5}) {
        const auto weights = axial_weights(s);
        std::vector<std::vector<Share>> shares;
        for (int k = 0; k < images; ++k)
            shares.push_back(axial_shares(weights, k, images));
        std::array<double, images> square{};
        for (int trial = 0; trial < trials; ++trial) {
            std::array<double, images> curve{};
            for (double& sample : curve)
                sample = normal(random);
            for (int average = 0; average < 2; ++average) {
                const auto before = curve;
                for (std::size_t k = 0; k < images; ++k) {
                    curve[k] = 0;
                    for (const Share& share : shares[k])
                        curve[k] += share.weight * before[static_cast<std::size_t>(share.image)];
                }
            }
            for (std::size_t k = 0; k < images; ++k)
                square[k] += curve[k] * curve[k];
        }
        const auto points = averaged_points(weights, images);
        for (std::size_t k = 0; k < images; ++k) // five standard errors: 5 sqrt(2 / 40000)
            EXPECT_NEAR(square[k] / trials / points[k].variance, 1, 0.036) << k << " " << s;
        if (s > 0) {
            EXPECT_GT(points[0].variance, 1.5 * points[images / 2].variance); // the ends average less
        }
    }
}

} // namespace
} // namespace vkfv::topography
