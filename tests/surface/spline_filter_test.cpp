#include "surface/spline_filter.hpp"

#include "core/mathematics/units.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace vkfv::surface {
namespace {

using namespace test;

constexpr double pitch = 0.002;

// A wave that, mirrored at its borders, goes on as it is.
double mode(int k, int point, int points) {
    return std::cos(pi * k * (point + 0.5) / points);
}

HeightMap mode_map(int k, int l) {
    return sampled(40, 30, pitch, [=](double x, double y) {
        return mode(k, static_cast<int>(std::lround((x + 0.3) / pitch)), 40) *
               mode(l, static_cast<int>(std::lround((y - 0.2) / pitch)), 30);
    });
}

TEST(SplineFilter, PassesEveryDirectionByItsTransmission) {
    for (const auto& [k, l] : {std::pair(4, 0), std::pair(0, 4), std::pair(8, 6), std::pair(3, 9)}) {
        const HeightMap wave = mode_map(k, l);
        const double frequency = std::hypot(k / (2 * 40 * pitch), l / (2 * 30 * pitch));
        for (const double ratio : {0.5, 1.0, 2.0}) { // nesting index over wavelength
            const HeightMap low = spline_low_pass(wave, ratio / frequency, SplineEnds::mirrored);
            for (std::size_t i = 0; i < low.height.values.size(); ++i)
                EXPECT_NEAR(low.height.values[i], wave.height.values[i] / (1 + std::pow(ratio, 4)), 1e-12);
        }
    }
    // The wrong twin, the Gaussian filter, passes 2^-(1/4) of twice the nesting index.
    const HeightMap wave = mode_map(4, 0);
    EXPECT_GT(
        std::abs(spline_low_pass(wave, 0.5 * 40 * pitch / 2, SplineEnds::mirrored).height(0, 0) / wave.height(0, 0) -
                 std::pow(0.5, 0.25)),
        0.05);
}

// Solves a system of equations by Gauss's elimination with pivots.
std::vector<double> solved(std::vector<std::vector<double>> matrix, std::vector<double> right) {
    const std::size_t n = right.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k; i < n; ++i)
            if (std::abs(matrix[i][k]) > std::abs(matrix[pivot][k]))
                pivot = i;
        std::swap(matrix[k], matrix[pivot]);
        std::swap(right[k], right[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double factor = matrix[i][k] / matrix[k][k];
            for (std::size_t j = k; j < n; ++j)
                matrix[i][j] -= factor * matrix[k][j];
            right[i] -= factor * right[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j)
            right[k] -= matrix[k][j] * right[j];
        right[k] /= matrix[k][k];
    }
    return right;
}

TEST(SplineFilter, LeavesGapsOutOfTheFitWithMirroredEnds) {
    const int columns = 9, rows = 8;
    auto map = sampled(columns, rows, pitch, [](double x, double y) { return std::sin(900 * x) + y * y + 3 * x; });
    forget_a_third(map);
    const double nesting_index = 5 * pitch;
    // The matrix is mu times the squared Laplacian, mode by mode.
    const auto n = static_cast<std::size_t>(columns * rows);
    std::vector<std::vector<double>> matrix(n, std::vector<double>(n));
    for (int k = 0; k < columns; ++k)
        for (int l = 0; l < rows; ++l) {
            const double frequency = std::hypot(k / (2 * columns * pitch), l / (2 * rows * pitch));
            const double norm = (k == 0 ? 1.0 : 2.0) / columns * (l == 0 ? 1.0 : 2.0) / rows;
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = 0; j < n; ++j) {
                    const auto value = [&](std::size_t point) {
                        return mode(k, static_cast<int>(point) % columns, columns) *
                               mode(l, static_cast<int>(point) / columns, rows);
                    };
                    matrix[i][j] += std::pow(nesting_index * frequency, 4) * norm * value(i) * value(j);
                }
        }
    std::vector<double> right(n);
    for (std::size_t i = 0; i < n; ++i)
        if (!std::isnan(map.height.values[i])) {
            matrix[i][i] += 1;
            right[i] = map.height.values[i];
        }
    const std::vector<double> expected = solved(matrix, right);
    const HeightMap low = spline_low_pass(map, nesting_index, SplineEnds::mirrored);
    for (std::size_t i = 0; i < n; ++i) {
        EXPECT_EQ(std::isnan(low.height.values[i]), std::isnan(map.height.values[i]));
        if (!std::isnan(low.height.values[i])) {
            // The residual ends at 1e-5 of the heights' norm, that of 50 heights of about 1.
            EXPECT_NEAR(low.height.values[i], expected[i], 1e-4);
        }
    }
}

// The matrix of natural ends: 1 where measured, plus the bending energy difference by difference.
std::vector<std::vector<double>> bending(const HeightMap& map, double nesting_index) {
    const int columns = map.columns(), rows = map.rows();
    const auto n = map.height.values.size();
    std::vector<std::vector<double>> matrix(n, std::vector<double>(n));
    struct Term {
        int column, row;
        double factor;
    };
    const auto add_square = [&](const std::vector<Term>& terms, double weight) {
        for (const Term& a : terms)
            for (const Term& b : terms) {
                if (std::max(a.column, b.column) >= columns || std::max(a.row, b.row) >= rows)
                    return;
                matrix[map.height.index(a.column, a.row)][map.height.index(b.column, b.row)] +=
                    weight * a.factor * b.factor;
            }
    };
    const auto inside = [&](int column, int row) { return column < columns && row < rows; };
    const double a_x = 0.5 / std::sin(pi * map.pitch_x / nesting_index);
    const double a_y = 0.5 / std::sin(pi * map.pitch_y / nesting_index);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            if (inside(i + 2, j))
                add_square({{i, j, 1}, {i + 1, j, -2}, {i + 2, j, 1}}, std::pow(a_x, 4));
            if (inside(i, j + 2))
                add_square({{i, j, 1}, {i, j + 1, -2}, {i, j + 2, 1}}, std::pow(a_y, 4));
            if (inside(i + 1, j + 1))
                add_square({{i, j, 1}, {i + 1, j, -1}, {i, j + 1, -1}, {i + 1, j + 1, 1}}, 2 * a_x * a_x * a_y * a_y);
            if (std::isfinite(map.height(i, j)))
                matrix[map.height.index(i, j)][map.height.index(i, j)] += 1;
        }
    return matrix;
}

TEST(SplineFilter, WithNaturalEndsIsTheSolutionOfItsEquations) {
    for (const auto& [columns, rows] : {std::pair(11, 8), std::pair(9, 9), std::pair(40, 1), std::pair(2, 30)})
        for (const bool gaps : {false, true})
            for (const double index : {3.0, 8.0, 60.0}) {
                auto map = sampled(columns, rows, pitch, [](double x, double y) {
                    return std::sin(900 * x) + 1e4 * (x + 0.3) * (y - 0.2) + 3 * x;
                });
                map.pitch_y = 0.003;
                if (gaps)
                    forget_a_third(map);
                const std::size_t n = map.height.values.size();
                std::vector<double> right(n);
                for (std::size_t k = 0; k < n; ++k)
                    right[k] = std::isnan(map.height.values[k]) ? 0 : map.height.values[k];
                const std::vector<double> expected = solved(bending(map, index * pitch), right);
                const HeightMap low = spline_low_pass(map, index * pitch);
                for (std::size_t k = 0; k < n; ++k)
                    if (!std::isnan(map.height.values[k])) {
                        // With gaps the iteration ends at its goal, 1e-5 of the norm of 100 heights of some units.
                        EXPECT_NEAR(low.height.values[k], expected[k], gaps ? 1e-3 : 1e-9)
                            << columns << " x " << rows << ", " << index;
                    }
            }
}

TEST(SplineFilter, WithNaturalEndsPassesAPlane) {
    auto map = sampled(200, 150, pitch, [](double x, double y) { return 0.4 + 0.2 * x - 0.3 * y; });
    for (const bool gaps : {false, true}) {
        if (gaps)
            forget_a_third(map);
        for (const double nesting_index : {0.01, 0.1, 1.0, 100.0}) {
            const HeightMap low = spline_low_pass(map, nesting_index);
            double greatest = 0;
            for (std::size_t k = 0; k < low.height.values.size(); ++k)
                greatest = std::fmax(greatest, std::abs(low.height.values[k] - map.height.values[k]));
            EXPECT_LT(greatest, 1e-12) << nesting_index;
        }
    }
    // The wrong twin: mirrored ends bend it.
    const HeightMap bent = spline_low_pass(map, 0.1, SplineEnds::mirrored);
    EXPECT_GT(std::abs(bent.height(0, 0) - map.height(0, 0)), 1e-4);
}

TEST(SplineFilter, WithNaturalEndsTransmitsByTheStandardsFunction) {
    // Heights are compared in the middle of a profile of 1000 points, 8 nesting indices from either end, where the
    // ends' influence is less than exp(-pi sqrt(2) 8) = 4e-16.
    const double index = 60 * pitch;
    for (const double points : {20.0, 45.0, 60.0, 90.0, 150.0}) {
        const double wavelength = points * pitch;
        const auto map = sampled(1000, 1, pitch, [=](double x, double) { return std::cos(2 * pi * x / wavelength); });
        const double transmission =
            1 / (1 + std::pow(std::sin(pi * pitch / wavelength) / std::sin(pi * pitch / index), 4));
        const HeightMap low = spline_low_pass(map, index);
        for (int k = 490; k < 510; ++k)
            EXPECT_NEAR(low.height(k, 0), transmission * map.height(k, 0), 1e-10);
    }
}

TEST(SplineFilter, DoesNotSeeAnOffset) {
    auto map = sampled(40, 30, pitch, [](double x, double y) { return 1e-3 * std::sin(300 * x) * std::cos(200 * y); });
    forget_a_third(map);
    HeightMap raised = map;
    for (double& z : raised.height.values)
        z += 10;
    const HeightMap low = spline_low_pass(map, 0.02), raised_low = spline_low_pass(raised, 0.02);
    for (std::size_t k = 0; k < low.height.values.size(); ++k)
        if (!std::isnan(low.height.values[k])) {
            // The two iterations end at the goal of 1e-5 of the heights' norm, that of 800 heights of 5e-4; rounding
            // may end one a step apart.
            EXPECT_NEAR(raised_low.height.values[k] - 10, low.height.values[k], 2e-7);
        }
}

TEST(SplineFilter, KeepsConstantsAndNeedsAPositiveNestingIndex) {
    auto map = sampled(30, 20, pitch, [](double, double) { return 0.7; });
    forget_a_third(map);
    for (const double z : spline_low_pass(map, 0.02).height.values)
        if (!std::isnan(z)) {
            EXPECT_NEAR(z, 0.7, 1e-4);
        }
    EXPECT_THROW(spline_low_pass(map, 0), std::invalid_argument);
    EXPECT_THROW(spline_low_pass(map, not_measured), std::invalid_argument);
    std::fill(map.height.values.begin(), map.height.values.end(), not_measured);
    EXPECT_TRUE(std::isnan(spline_low_pass(map, 0.02).height(3, 3)));
}

} // namespace
} // namespace vkfv::surface
