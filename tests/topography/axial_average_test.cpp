#include "topography/axial_average.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace vkfv::topography {
namespace {

constexpr std::array deviations = {0.0, 0.5, 1.0, 4.0};
constexpr int images = 10;

TEST(AxialAverage, FarFromTheEndsIsTheNormalisedWeightedMean) {
    constexpr int many = 40, middle = 20;
    for (const double s : deviations) {
        double total = 0;
        const int radius = static_cast<int>(std::ceil(3 * s));
        const auto weight = [&](int d) { return d == 0 ? 1 : std::exp(-0.5 * std::pow(d / s, 2)); };
        for (int d = -radius; d <= radius; ++d)
            total += weight(d);
        const auto shares = axial_shares(axial_weights(s), middle, many);
        ASSERT_EQ(shares.size(), static_cast<std::size_t>(2 * radius + 1));
        for (const Share& share : shares)
            EXPECT_NEAR(share.weight, weight(share.image - middle) / total, 6e-8); // float32 of a number below 1
    }
}

// What the mean of the images present does not do at the ends.
TEST(AxialAverage, AStraightLineStaysItselfUpToTheEnds) {
    for (const double s : deviations)
        for (int k = 0; k < images; ++k) {
            double one = 0, line = 0;
            for (const Share& share : axial_shares(axial_weights(s), k, images)) {
                one += share.weight;
                line += share.weight * share.image;
            }
            EXPECT_NEAR(one, 1, 1e-6);  // as many float32 as images, of numbers below 2
            EXPECT_NEAR(line, k, 1e-5) << s;
        }
}

// Energies of white noise, over so many values that the fourth powers' share is small, averaged as images and as curves.
TEST(AxialAverage, VariancesAreThoseOfAveragedNoise) {
    constexpr int values = 8, trials = 20000;
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (const double s : {0.0, 1.5}) {
        const auto weights = axial_weights(s);
        std::vector<std::vector<Share>> shares;
        for (int k = 0; k < images; ++k)
            shares.push_back(axial_shares(weights, k, images));
        std::array<double, images> sum{}, square{};
        for (int trial = 0; trial < trials; ++trial) {
            std::array<double, images> curve{};
            for (int value = 0; value < values; ++value) {
                std::array<double, images> noise{};
                for (double& sample : noise)
                    sample = normal(random);
                for (int k = 0; k < images; ++k) {
                    double mean = 0;
                    for (const Share& share : shares[static_cast<std::size_t>(k)])
                        mean += share.weight * noise[static_cast<std::size_t>(share.image)];
                    curve[static_cast<std::size_t>(k)] += mean * mean;
                }
            }
            for (std::size_t k = 0; k < images; ++k) {
                double mean = 0;
                for (const Share& share : shares[k])
                    mean += share.weight * curve[static_cast<std::size_t>(share.image)];
                sum[k] += mean;
                square[k] += mean * mean;
            }
        }
        const auto variances = averaged_variances(weights, images);
        for (std::size_t k = 0; k < images; ++k) {
            const double found = (square[k] - sum[k] * sum[k] / trials) / (trials - 1) / (2.0 * values); // of one: 2 a value
            // Excess kurtosis of a sum of 8 squares: 12 / 8; five standard errors: 5 sqrt((2 + 1.5) / 20000) = 6.6 %.
            EXPECT_NEAR(found / variances[k], 1, 0.066) << k << " " << s;
        }
        if (s > 0) {
            EXPECT_GT(variances[0], 2 * variances[images / 2]); // the ends average less
        }
    }
}

} // namespace
} // namespace vkfv::topography
