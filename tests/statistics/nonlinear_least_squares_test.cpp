// Levenberg and Marquardt's search finds minima in closed form, and counts its evaluations.
#include "statistics/nonlinear_least_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace vkfv::statistics {
namespace {
namespace of_nonlinear_least_squares { // files of a unity build share the unnamed namespace

// Rosenbrock's valley, 10 (y - x^2) and 1 - x, whose least sum is 0 at (1, 1).
Residuals valley(int& evaluations) {
    return {.values =
                [&evaluations](const std::vector<double>& at) {
                    ++evaluations;
                    return std::vector<double>{10 * (at[1] - at[0] * at[0]), 1 - at[0]};
                },
            .slopes =
                [](const std::vector<double>& at) {
                    Matrix slopes(2, 2);
                    slopes(0, 0) = -20 * at[0];
                    slopes(0, 1) = 10;
                    slopes(1, 0) = -1;
                    return slopes;
                }};
}

TEST(NonlinearLeastSquares, FindsTheEndOfAValley) {
    int evaluations = 0;
    const auto end = nonlinear_least_squares(valley(evaluations), {-1.2, 1}, 1e-10, 100);
    EXPECT_TRUE(end.converged);
    EXPECT_NEAR(end.unknowns[0], 1, 1e-8);
    EXPECT_NEAR(end.unknowns[1], 1, 1e-8);
    EXPECT_EQ(end.evaluations, evaluations);
}

TEST(NonlinearLeastSquares, EndsWhenItsEvaluationsAreUsedUp) {
    int evaluations = 0;
    const auto end = nonlinear_least_squares(valley(evaluations), {-1.2, 1}, 1e-10, 4);
    EXPECT_FALSE(end.converged);
    EXPECT_LE(evaluations, 5);
    EXPECT_NE(end.unknowns[0], 1);
}

TEST(NonlinearLeastSquares, RefusesFewerResidualsThanUnknowns) {
    const Residuals one{.values = [](const std::vector<double>&) { return std::vector<double>{1}; },
                        .slopes = [](const std::vector<double>&) { return Matrix(1, 2); }};
    EXPECT_THROW((void)nonlinear_least_squares(one, {0, 0}, 1e-3, 10), std::invalid_argument);
}

} // namespace of_nonlinear_least_squares
} // namespace
} // namespace vkfv::statistics
