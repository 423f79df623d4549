#include "surface/sphere.hpp"

#include "surface/height_parameters.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vkfv::surface {
namespace {

using namespace test;

// A cap over a disc of the radius 0.1 mm about (-0.2, 0.3).
HeightMap cap(double radius, bool convex) {
    return sampled(101, 101, 0.002, [=](double x, double y) {
        const double square = std::pow(x + 0.2, 2) + std::pow(y - 0.3, 2);
        const double depth = square / (radius + std::sqrt(radius * radius - square));
        return square < 0.01 ? 0.5 + (convex ? -depth : depth) : not_measured;
    });
}

TEST(Sphere, IsFoundFromAlmostAHemisphereToAlmostAPlane) {
    for (const bool convex : {true, false})
        for (const double radius : {0.1001, 0.2, 1.0, 30.0, 1000.0}) {
            auto map = cap(radius, convex);
            forget_a_third(map);
            const Sphere sphere = least_squares_sphere(map);
            // Heights of 0.5 mm carry rounding of 1e-16 mm; the radius is known from a sagitta of 0.005 / radius.
            const double relative = 1e-16 / (0.005 / radius);
            EXPECT_NEAR(sphere.radius, radius, radius * (1e-9 + relative)) << radius;
            EXPECT_NEAR(sphere.apex, 0.5, 1e-12) << radius;
            EXPECT_NEAR(sphere.x_centre, -0.2, 1e-9 + 1e-14 * radius) << radius;
            EXPECT_NEAR(sphere.y_centre, 0.3, 1e-9 + 1e-14 * radius) << radius;
            EXPECT_EQ(sphere.convex, convex);
            EXPECT_LT(height_parameters(remove_sphere(map, sphere)).sq, 1e-10) << radius;
        }
}

TEST(Sphere, MinimisesTheDistancesAndNotTheHeights) {
    // Points moved along the normal of a deep cap leave the radius free of bias, but for sigma^2 / radius = 1e-7 mm.
    // The standard error is that of 20 draws.
    const double radius = 0.105, sigma = 1e-4;
    double sum = 0, squares = 0;
    const int draws = 20;
    for (int draw = 0; draw < draws; ++draw) {
        std::mt19937_64 random(static_cast<std::uint64_t>(draw) + 11);
        std::normal_distribution<double> normal(0, sigma);
        auto map = cap(radius, true);
        for (int row = 0; row < map.rows(); ++row)
            for (int column = 0; column < map.columns(); ++column) {
                const double square = std::pow(map.x(column) + 0.2, 2) + std::pow(map.y(row) - 0.3, 2);
                const double r = radius + normal(random);
                map.height(column, row) = square < 0.0081 ? 0.5 - radius + std::sqrt(r * r - square) : not_measured;
            }
        const double found = least_squares_sphere(map).radius - radius;
        sum += found;
        squares += found * found;
    }
    const double mean = sum / draws;
    const double error = std::sqrt((squares / draws - mean * mean) / (draws - 1));
    // Student's t of 19 degrees of freedom exceeds 4.6 with the probability 2e-4.
    EXPECT_LT(std::abs(mean), 4.6 * error);
    EXPECT_GT(error, 0);
    // The wrong twin is a radius sigma / 10 longer.
    EXPECT_GT(std::abs(mean - sigma / 10), 4.6 * error);
}

TEST(Sphere, IsNotFoundWhereThereIsNone) {
    EXPECT_TRUE(std::isnan(least_squares_sphere(sampled(9, 9, 0.1, [](double, double) { return 0.2; })).radius));
    EXPECT_TRUE(std::isnan(least_squares_sphere(sampled(9, 9, 0.1, [](double x, double y) { return x - y; })).radius));
    EXPECT_TRUE(std::isnan(least_squares_sphere(sampled(9, 9, 1, [](double, double) { return not_measured; })).radius));
}

TEST(Sphere, LeavesWhatLiesBeyondItNotMeasured) {
    const auto map = sampled(5, 1, 1, [](double, double) { return 0.0; });
    const HeightMap rest = remove_sphere(map, {.x_centre = -0.3, .y_centre = 0.2, .apex = 1, .radius = 2.5});
    EXPECT_DOUBLE_EQ(rest.height(0, 0), -1);
    EXPECT_FALSE(std::isnan(rest.height(2, 0)));
    EXPECT_TRUE(std::isnan(rest.height(3, 0)));
}

} // namespace
} // namespace vkfv::surface
