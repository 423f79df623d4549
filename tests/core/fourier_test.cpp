#include "core/mathematics/fourier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

using vkfv::Grid;
using Complex = std::complex<double>;

namespace {

Grid<Complex> noise(int columns, int rows) {
    Grid<Complex> grid(columns, rows);
    std::uint32_t state = 1;
    for (Complex& value : grid.values) { // a linear congruential generator (Numerical Recipes' constants)
        const double re = (state = state * 1664525u + 1013904223u);
        const double im = (state = state * 1664525u + 1013904223u);
        value = Complex(re, im) / 4294967296.0 - Complex(0.5, 0.5);
    }
    return grid;
}

// The sum as the definition writes it.
Complex transformed_at(const Grid<Complex>& grid, int l, int m) {
    Complex sum = 0;
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column)
            sum += grid(column, row) * std::polar(1.0, -2 * std::numbers::pi *
                                                           (static_cast<double>(column * l) / grid.columns +
                                                            static_cast<double>(row * m) / grid.rows));
    return sum;
}

// Rounding of a sum of n values below 1, whose phases are rounded at up to 2 pi n: below 2 pi n epsilon each.
double rounding(const Grid<Complex>& grid) {
    const auto n = static_cast<double>(grid.values.size());
    return 2 * std::numbers::pi * n * n * std::numeric_limits<double>::epsilon();
}

class Fourier : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(Fourier, IsTheSumOfItsDefinition) {
    const auto [columns, rows] = GetParam();
    const Grid<Complex> before = noise(columns, rows);
    Grid<Complex> after = before;
    vkfv::fourier_transform(after);
    for (int m = 0; m < rows; ++m)
        for (int l = 0; l < columns; ++l)
            EXPECT_LT(std::abs(after(l, m) - transformed_at(before, l, m)), rounding(before)) << l << " " << m;
}

TEST_P(Fourier, InverseGivesTheGridBack) {
    const auto [columns, rows] = GetParam();
    const Grid<Complex> before = noise(columns, rows);
    Grid<Complex> grid = before;
    vkfv::fourier_transform(grid);
    vkfv::inverse_fourier_transform(grid);
    for (std::size_t k = 0; k < grid.values.size(); ++k)
        EXPECT_LT(std::abs(grid.values[k] - before.values[k]), rounding(before));
}

TEST_P(Fourier, CosineTransformIsTheSumOfItsDefinition) {
    const auto [columns, rows] = GetParam();
    Grid<double> before(columns, rows);
    const Grid<Complex> random = noise(columns, rows);
    for (std::size_t k = 0; k < before.values.size(); ++k)
        before.values[k] = random.values[k].real();
    Grid<double> after = before;
    vkfv::cosine_transform(after);
    for (int m = 0; m < rows; ++m)
        for (int l = 0; l < columns; ++l) {
            double sum = 0;
            for (int row = 0; row < rows; ++row)
                for (int column = 0; column < columns; ++column)
                    sum += before(column, row) * std::cos(std::numbers::pi * l * (2 * column + 1) / (2.0 * columns)) *
                           std::cos(std::numbers::pi * m * (2 * row + 1) / (2.0 * rows));
            EXPECT_NEAR(after(l, m), sum, rounding(random)) << l << " " << m;
        }
    vkfv::inverse_cosine_transform(after);
    for (std::size_t k = 0; k < before.values.size(); ++k)
        EXPECT_NEAR(after.values[k], before.values[k], rounding(random)) << k;
}

// A power of two, one of factors 2, 3 and 5, and a prime; a single row; lengths with prime factors above 13, which are
// transformed by a convolution.
INSTANTIATE_TEST_SUITE_P(Sizes, Fourier,
                         testing::Values(std::pair{8, 4}, std::pair{6, 15}, std::pair{7, 5}, std::pair{16, 1},
                                         std::pair{17, 13}, std::pair{38, 23}));

// A long prime takes some six times as long as the convenient length beside it: three transforms of twice the length.
// KISS FFT alone, the wrong twin, took 2800 times as long.
TEST(FourierTransform, LongPrimesAreTransformedAsFastAsTheirNeighbours) {
    const auto seconds = [](int length) {
        Grid<Complex> grid = noise(length, 8);
        double least = std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            const auto began = std::chrono::steady_clock::now();
            vkfv::fourier_transform(grid);
            least = std::min(least, std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
        }
        return least;
    };
    EXPECT_LT(seconds(16381), 40 * seconds(16384));
}

TEST(ConvenientLength, HasNoFactorAboveFive) {
    EXPECT_EQ(vkfv::convenient_length(1), 1);
    EXPECT_EQ(vkfv::convenient_length(7), 8);
    EXPECT_EQ(vkfv::convenient_length(257), 270);
    EXPECT_EQ(vkfv::convenient_length(1999), 2000);
}

TEST(FourierFrequency, IsNegativeFromHalfTheSizeOn) {
    EXPECT_DOUBLE_EQ(vkfv::fourier_frequency(3, 8), 0.375);
    EXPECT_DOUBLE_EQ(vkfv::fourier_frequency(4, 8), -0.5);
    EXPECT_DOUBLE_EQ(vkfv::fourier_frequency(3, 5), -0.4);
}

} // namespace
