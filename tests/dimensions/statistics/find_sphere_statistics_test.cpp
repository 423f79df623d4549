#include "dimensions/find.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vkfv::dimensions {
namespace {

using surface::HeightMap;

constexpr int points = 128, seeds = 20, fewest_good = 19;
constexpr double pitch = 5e-4, pi_ = 3.14159265358979323846; // mm

// A cap of this share of the field upon a tilted plane, with noise of a share of its sag.
HeightMap cap_map(double radius, double share, double noise, unsigned seed) {
    HeightMap map{.height = Grid<double>(points, points), .x0 = 0, .y0 = 0, .pitch_x = pitch, .pitch_y = pitch};
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const double field = (points - 1) * pitch, rim = share * field / 2;
    const double ground = std::sqrt(radius * radius - rim * rim), sag = radius - ground;
    for (int row = 0; row < points; ++row)
        for (int column = 0; column < points; ++column) {
            const double x = map.x(column) - field / 2 - 1e-3, y = map.y(row) - field / 2 + 5e-4;
            const double square = x * x + y * y;
            map.height(column, row) = (square < rim * rim ? std::sqrt(radius * radius - square) - ground : 0) +
                                      0.004 * x - 0.002 * y + noise * sag * normal(random);
        }
    return map;
}

// The standard error with which a least-squares fit of z = a + b x + c y + r^2 / (2 R) to all points of the true cap
// knows its radius: var(r^2) over a circle of radius a is a^4 / 12.
double fit_error(double radius, double share, double noise) {
    const double rim = share * (points - 1) * pitch / 2;
    const double sag = radius - std::sqrt(radius * radius - rim * rim);
    const double count = pi_ * rim * rim / (pitch * pitch);
    return radius * radius * noise * sag * 2 * std::sqrt(12 / count) / (rim * rim);
}

// The number of maps whose radius is within three stated errors of `radius`.
int good(double true_radius, double radius, double share, double noise, double* largest_error = nullptr) {
    int count = 0;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        const auto found = evaluate_found(cap_map(true_radius, share, noise, seed), Sought::sphere);
        if (found.empty())
            continue;
        count += std::abs(found[0].value - radius) <= 3 * found[0].standard_error ? 1 : 0;
        if (largest_error != nullptr)
            *largest_error = std::max(*largest_error, found[0].standard_error);
    }
    return count;
}

TEST(FindSphereStatistics, ACapIsFoundAndItsErrorStatedHonestly) {
    for (const double share : {0.3, 0.6, 0.9})
        for (const double noise : {0.005, 0.05}) {
            constexpr double radius = 0.2;
            double largest = 0;
            EXPECT_GE(good(radius, radius, share, noise, &largest), fewest_good) << share << ", " << noise;
            EXPECT_LE(largest, 2 * fit_error(radius, share, noise)) << share << ", " << noise;
        }
}

// The wrong twin: a radius ten fit errors off is not taken for the cap's.
TEST(FindSphereStatistics, AnotherRadiusIsRejected) {
    constexpr double radius = 0.2, share = 0.6, noise = 0.02;
    EXPECT_LT(good(radius, radius + 10 * fit_error(radius, share, noise), share, noise), fewest_good);
}

} // namespace
} // namespace vkfv::dimensions
