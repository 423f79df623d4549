#include "topography/repeatability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace vkfv::topography {
namespace {

using surface::HeightMap;

// Repeated maps with a bias of root mean square 1e-4 mm, noise as given, and a tenth of the points of each not
// measured.
std::vector<HeightMap> repetitions(int count, double sigma, unsigned seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0, sigma);
    std::vector<HeightMap> maps;
    for (int k = 0; k < count; ++k) {
        HeightMap map{.height = Grid<double>(100, 80), .x0 = 0, .y0 = 0, .pitch_x = 1, .pitch_y = 1};
        for (int row = 0; row < 80; ++row)
            for (int column = 0; column < 100; ++column) {
                const double bias = (column + row) % 2 == 0 ? 1e-4 : -1e-4;
                map.height(column, row) = bias + normal(random);
                if (random() % 10 == 0)
                    map.height(column, row) = std::numeric_limits<double>::quiet_NaN();
            }
        maps.push_back(std::move(map));
    }
    return maps;
}

TEST(Repeatability, ToldApartWithoutBias) {
    const double bias = 1e-4, sigma = 3e-4;
    for (const int n : {2, 10}) {
        const SystematicAndRandom parts = systematic_and_random(repetitions(n, sigma, 21));
        // A point has about 0.9 n measurements; of the mean square of 8000 (with n = 2: 6480) points the noise's share
        // is sigma^2 / (0.9 n), its standard error that times sqrt(2 / points), twice as much with its own estimate at
        // n = 2, and of the product with the bias 2 bias sigma / sqrt(0.9 n points). These are divided by 2 bias, and
        // five of them are allowed.
        const double points = n == 2 ? 6480 : 8000, noise = sigma * sigma / (0.9 * n);
        const double error = (2 * noise * std::sqrt(2 / points) + 2 * bias * std::sqrt(noise / points)) / (2 * bias);
        EXPECT_NEAR(parts.systematic, bias, 5 * error);
        // The wrong twin leaves the mean's own scatter in.
        if (n == 10) {
            EXPECT_GT(std::abs(parts.systematic - std::sqrt(bias * bias + noise)), 5 * error);
        }
        const double freedoms = points * (n == 2 ? 1 : 8);
        EXPECT_NEAR(parts.random, sigma, 5 * sigma / std::sqrt(2 * freedoms));
        // The wrong twin divides by n instead of n - 1.
        EXPECT_GT(std::abs(parts.random - sigma * std::sqrt(1 - 1.0 / n)), 5 * sigma / std::sqrt(2 * freedoms));
        EXPECT_NEAR(parts.points, points, 0.05 * points);
    }
}

TEST(Repeatability, KnowsItsErrors) {
    // Over 200 draws of 6 repetitions the mean squared error that is said is compared with that which is seen. Each of
    // the two is known to 10 % from 200 squares (of a chi-square of 1 and of 5 degrees: sqrt(2 / 200), sqrt(2 / 1000)).
    double systematic_seen = 0, systematic_said = 0, random_seen = 0, random_said = 0;
    const int draws = 200;
    for (int draw = 0; draw < draws; ++draw) {
        auto maps = repetitions(6, 1e-4, static_cast<unsigned>(1000 + draw));
        for (HeightMap& map : maps) // a corner of 20 x 20 is enough
            map = {.height =
                       [&] {
                           Grid<double> corner(20, 20);
                           for (int row = 0; row < 20; ++row)
                               for (int column = 0; column < 20; ++column)
                                   corner(column, row) = map.height(column, row);
                           return corner;
                       }(),
                   .x0 = 0,
                   .y0 = 0,
                   .pitch_x = 1,
                   .pitch_y = 1};
        const SystematicAndRandom parts = systematic_and_random(maps);
        systematic_seen += std::pow(parts.systematic - 1e-4, 2);
        random_seen += std::pow(parts.random - 1e-4, 2);
        systematic_said += std::pow(parts.systematic_error, 2);
        random_said += std::pow(parts.random_error, 2);
    }
    // The bounds are four standard deviations of a ratio known to 11 %, and the jackknife's own bias, at most 1 / 6
    // upwards.
    EXPECT_GT(systematic_said / systematic_seen, 0.56);
    EXPECT_LT(systematic_said / systematic_seen, 1.44 * 7 / 6);
    EXPECT_GT(random_said / random_seen, 0.56);
    EXPECT_LT(random_said / random_seen, 1.44 * 7 / 6);
}

TEST(Repeatability, MapsMeanAndStandardDeviation) {
    auto maps = repetitions(3, 0, 1);
    for (std::size_t k = 0; k < 3; ++k)
        maps[k].height(4, 4) = static_cast<double>(k); // 0, 1, 2
    maps[0].height(5, 5) = maps[1].height(5, 5) = std::numeric_limits<double>::quiet_NaN();
    const SystematicAndRandom parts = systematic_and_random(maps);
    EXPECT_DOUBLE_EQ(parts.mean_deviation.height(4, 4), 1);
    EXPECT_DOUBLE_EQ(parts.standard_deviation.height(4, 4), 1);
    EXPECT_TRUE(std::isnan(parts.mean_deviation.height(5, 5))); // once is not repeated
    EXPECT_THROW(systematic_and_random(std::span(maps).first(1)), std::invalid_argument);
    maps[1].height = Grid<double>(3, 3);
    EXPECT_THROW(systematic_and_random(maps), std::invalid_argument);
}

} // namespace
} // namespace vkfv::topography
