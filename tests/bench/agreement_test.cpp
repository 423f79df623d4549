// Synthetic Poisson images, of which it is known whether two have one expectation, are told apart as often as stated.
#include "bench/agreement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace vkfv;

namespace {

constexpr int side = 100;          // not a multiple of the block's side
constexpr double per_ray = 3.7e-9; // W

// Counts about a pattern of stripes as wide as a block, `shift` pixels along x.
bench::Measured image(std::mt19937_64& random, double mean, int shift = 0) {
    Grid<double> flux(side, side);
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const double stripe = ((column + shift) / bench::block_side) % 2 == 0 ? 1.3 : 0.7;
            flux(column, row) = per_ray * std::poisson_distribution<int>(mean * stripe)(random);
        }
    }
    return bench::measured_counts(flux, per_ray);
}

} // namespace

// In 400 pairs with mean counts from 0.05 a pixel (3 a block) on, p < 0.05 in 20 +- 4.4. The bounds are at 4.5 standard
// deviations, with the conservative side open for few counts, whose chi-square varies less: the false-positive rate is
// 7e-6.
TEST(Agreement, EqualExpectationsAreFoundApartAsOftenAsStated) {
    std::mt19937_64 random(11);
    for (const double mean : {0.05, 5.0}) {
        int apart = 0;
        double chi_square = 0, degrees = 0;
        for (int pair = 0; pair < 400; ++pair) {
            const auto agreement = bench::compare(image(random, mean), image(random, mean));
            apart += agreement.holds(0.05) ? 0 : 1;
            chi_square += agreement.chi_square;
            degrees += agreement.degrees;
        }
        EXPECT_LE(apart, 20 + 4.5 * std::sqrt(400 * 0.05 * 0.95));
        EXPECT_GE(apart, mean > 1 ? 20 - 4.5 * std::sqrt(400 * 0.05 * 0.95) : 1);
        // There are 13 x 13 blocks, 400 times: the mean of chi-square per block is 1 +- sqrt(2 / 67600).
        EXPECT_NEAR(chi_square / degrees, 1, 4.5 * std::sqrt(2 / degrees));
    }
}

// Wrong twins: 3 % more light with 50000 counts is 4.7 standard errors; stripes that stand elsewhere have the same
// total.
TEST(Agreement, WhatDiffersIsFoundApart) {
    std::mt19937_64 random(12);
    const auto reference = image(random, 5);
    EXPECT_TRUE(bench::compare(reference, image(random, 5)).holds(1e-3));
    EXPECT_FALSE(bench::compare(reference, image(random, 5.15)).holds(1e-3));
    const auto moved = bench::compare(reference, image(random, 5, 1));
    EXPECT_FALSE(moved.holds(1e-3));
    EXPECT_GT(moved.chi_square, 1.5 * moved.degrees);
}
