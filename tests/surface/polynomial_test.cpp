#include "surface/polynomial.hpp"

#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace vkfv::surface {
namespace {

using namespace test;

// Every term up to degree 4, over a frame far from the origin.
double quartic(double x, double y) {
    return 0.1 + x - 2 * y + 3 * x * x - x * y + y * y + 5 * x * x * x - 2 * x * y * y + 7 * x * x * y * y + y * y * y * y;
}

TEST(Polynomial, IsFoundToRoundingOverTheMeasuredPoints) {
    auto map = sampled(60, 45, 0.01, quartic);
    forget_a_third(map);
    const Polynomial form = least_squares_polynomial(map, 4);
    const HeightMap level = remove_polynomial(map, form);
    int measured = 0;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            // Between and at the gaps too.
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

TEST(Polynomial, NeedsADegreeFromZeroToTwenty) {
    const auto map = sampled(3, 3, 0.002, [](double, double) { return 0.0; });
    EXPECT_THROW(least_squares_polynomial(map, -1), std::invalid_argument);
    EXPECT_THROW(least_squares_polynomial(map, 21), std::invalid_argument);
}

} // namespace
} // namespace vkfv::surface
