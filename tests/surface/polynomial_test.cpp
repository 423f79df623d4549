#include "surface/polynomial.hpp"

#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace vkfv::surface {
namespace {

using namespace test;

// A polynomial with every term up to degree 4, over a frame far from the origin.
double quartic(double x, double y) {
    return 0.1 + x - 2 * y + 3 * x * x - x * y + y * y + 5 * x * x * x - 2 * x * y * y + 7 * x * x * y * y +
           y * y * y * y;
}

TEST(Polynomial, IsFoundToRoundingOverTheMeasuredPoints) {
    auto map = sampled(60, 45, 0.01, quartic);
    forget_a_third(map);
    const Polynomial form = least_squares_polynomial(map, 4);
    const HeightMap level = remove_polynomial(map, form);
    int measured = 0;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            // The form is exact between the points and at the gaps too.
            EXPECT_NEAR(form.height(map.x(column), map.y(row)), quartic(map.x(column), map.y(row)), 1e-12);
            EXPECT_EQ(std::isnan(level.height(column, row)), std::isnan(map.height(column, row)));
            measured += !std::isnan(level.height(column, row));
        }
    EXPECT_GT(measured, 1500);
    EXPECT_LT(height_parameters(level).sz, 1e-12);
    // A lower degree leaves the quartic terms.
    EXPECT_GT(height_parameters(remove_polynomial(map, least_squares_polynomial(map, 3))).sz, 1e-3);
}

TEST(Polynomial, OfDegreeOneIsTheLeastSquaresPlane) {
    auto map = sampled(40, 30, 0.002, [](double x, double y) { return std::sin(300 * x) + y * y; });
    forget_a_third(map);
    const HeightMap a = remove_polynomial(map, least_squares_polynomial(map, 1));
    const HeightMap b = remove_plane(map, least_squares_plane(map));
    for (std::size_t k = 0; k < a.height.values.size(); ++k)
        if (!std::isnan(map.height.values[k])) {
            EXPECT_NEAR(a.height.values[k], b.height.values[k], 1e-12);
        }
}

TEST(Polynomial, TakesWhatThePointsLeaveOpenAsSmall) {
    auto map = sampled(5, 5, 0.002, [](double x, double) { return x; });
    for (int row = 0; row < 5; ++row)
        for (int column = 0; column < 5; ++column)
            if (row != column)
                map.height(column, row) = not_measured;
    const Polynomial form = least_squares_polynomial(map, 2);
    for (int k = 0; k < 5; ++k)
        EXPECT_NEAR(form.height(map.x(k), map.y(k)), map.x(k), 1e-10);
    for (const double coefficient : form.coefficients)
        EXPECT_LT(std::abs(coefficient), 0.4); // the heights themselves reach 0.3
    for (double& z : map.height.values)
        z = not_measured;
    EXPECT_TRUE(std::isnan(least_squares_polynomial(map, 2).height(0, 0)));
}

// The greatest cosine of the angle between the residual and a product of powers over the measured points' extent.
double worst_projection(const HeightMap& level, int degree) {
    double x_low = 1e9, x_high = -1e9, y_low = 1e9, y_high = -1e9;
    const auto over_measured = [&](auto&& visit) {
        for (int row = 0; row < level.rows(); ++row)
            for (int column = 0; column < level.columns(); ++column)
                if (const double z = level.height(column, row); !std::isnan(z))
                    visit(level.x(column), level.y(row), z);
    };
    over_measured([&](double x, double y, double) {
        x_low = std::min(x_low, x);
        x_high = std::max(x_high, x);
        y_low = std::min(y_low, y);
        y_high = std::max(y_high, y);
    });
    double worst = 0;
    for (int i = 0; i <= degree; ++i)
        for (int j = 0; i + j <= degree; ++j) {
            double product = 0, squares = 0, powers = 0;
            over_measured([&](double x, double y, double z) {
                const double u = (2 * x - x_low - x_high) / (x_high - x_low),
                             v = (2 * y - y_low - y_high) / (y_high - y_low);
                const double power = std::pow(u, i) * std::pow(v, j);
                product += z * power;
                squares += z * z;
                powers += power * power;
            });
            worst = std::max(worst, std::abs(product) / std::sqrt(squares * powers));
        }
    return worst;
}

TEST(Polynomial, OfAHighDegreeIsTheLeastSquaresOneWhateverIsMeasured) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const auto noise = sampled(80, 80, 0.01, [&](double, double) { return 0.5 + 1e-3 * normal(random); });
    const auto measured_where = [&](const auto& measured) {
        HeightMap map = noise;
        for (int row = 0; row < map.rows(); ++row)
            for (int column = 0; column < map.columns(); ++column)
                if (!measured(column, row))
                    map.height(column, row) = not_measured;
        return map;
    };
    const HeightMap half = measured_where([](int column, int) { return column < 40; });
    const HeightMap corner = measured_where([](int column, int row) { return column < 25 || row < 20; });
    const HeightMap ring = measured_where([](int column, int row) {
        const double r = std::hypot(column - 39.5, row - 39.5);
        return r > 28 && r < 39;
    });
    for (const HeightMap& map : {half, corner, ring})
        for (const int degree : {9, 15}) {
            const HeightMap level = remove_polynomial(map, least_squares_polynomial(map, degree));
            // Heights of 500 times the residual, and coefficients far greater along what the gaps all but leave open,
            // round to 1e-16 of either.
            EXPECT_LT(worst_projection(level, degree), 1e-8) << degree;
        }
}

TEST(Polynomial, NeedsADegreeFromZeroToTwenty) {
    const auto map = sampled(3, 3, 0.002, [](double, double) { return 0.0; });
    EXPECT_THROW(least_squares_polynomial(map, -1), std::invalid_argument);
    EXPECT_THROW(least_squares_polynomial(map, 21), std::invalid_argument);
}

} // namespace
} // namespace vkfv::surface
