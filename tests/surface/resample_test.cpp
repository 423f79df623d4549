#include "surface/resample.hpp"

#include "core/mathematics/units.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vkfv::surface {
namespace {

using namespace test;

// A grid inside that of sampled(60, 50, 0.01, ...), which spans -0.3..0.29 and 0.2..0.69.
HeightMap grid(int columns, int rows, double x0, double y0, double pitch) {
    return {.height = Grid<double>(columns, rows), .x0 = x0, .y0 = y0, .pitch_x = pitch, .pitch_y = pitch};
}

TEST(Resample, ReturnsItsOwnPoints) {
    auto map = sampled(60, 50, 0.01, [](double x, double y) { return std::sin(90 * x) * std::cos(70 * y); });
    forget_a_third(map);
    const HeightMap same = resampled(map, map);
    for (std::size_t k = 0; k < map.height.values.size(); ++k) {
        EXPECT_EQ(std::isnan(same.height.values[k]), std::isnan(map.height.values[k]));
        if (!std::isnan(map.height.values[k])) {
            EXPECT_DOUBLE_EQ(same.height.values[k], map.height.values[k]);
        }
    }
}

TEST(Resample, IsExactForParabolasWhereTheMapIsCoarserAndForPlanesUpToItsBorders) {
    // Keys's kernel with a = -1/2 reproduces polynomials of the second degree; with any other a it does not.
    const auto parabola = [](double x, double y) { return 3 * x * x - 2 * x * y + y * y + x - 1; };
    const HeightMap inside = resampled(sampled(60, 50, 0.01, parabola), grid(100, 90, -0.2871, 0.2133, 0.005));
    for (int row = 0; row < inside.rows(); ++row)
        for (int column = 0; column < inside.columns(); ++column)
            EXPECT_NEAR(inside.height(column, row), parabola(inside.x(column), inside.y(row)), 1e-13);
    const auto plane = [](double x, double y) { return 3 * x - 2 * y + 1; };
    const HeightMap whole = resampled(sampled(60, 50, 0.01, plane), grid(118, 98, -0.2999, 0.2001, 0.005));
    for (int row = 0; row < whole.rows(); ++row)
        for (int column = 0; column < whole.columns(); ++column)
            EXPECT_NEAR(whole.height(column, row), plane(whole.x(column), whole.y(row)), 1e-13);
}

TEST(Resample, AveragesAFinerMapOverTheCell) {
    // The mean over a width w of a wave is sin(pi w / wavelength) / (pi w / wavelength) of it. Here the mean is one
    // over cells of a seventh of that width, whose own mean is missing: (pi / 7 w / wavelength)^2 / 6 = 3e-3.
    const double pitch = 0.01, wavelength = 0.25, width = 0.07;
    const auto map = sampled(60, 50, pitch, [=](double x, double) { return std::cos(2 * pi * x / wavelength); });
    const HeightMap coarse = resampled(map, grid(6, 4, -0.2, 0.27, width));
    const double u = pi * width / wavelength;
    for (int column = 0; column < 6; ++column)
        EXPECT_NEAR(coarse.height(column, 2), std::sin(u) / u * std::cos(2 * pi * coarse.x(column) / wavelength), 3e-3);
    // Waves that the coarse grid cannot resolve do not alias: sampled point by point, they would be seen in full.
    const auto fine = sampled(60, 50, pitch, [=](double x, double) { return std::cos(2 * pi * x / width); });
    for (const double z : resampled(fine, grid(6, 4, -0.2, 0.27, width)).height.values)
        EXPECT_NEAR(z, 0, 1e-12);
}

TEST(Resample, KeepsPlanesWhereTheMapIsFiner) {
    const auto plane = [](double x, double y) { return 3 * x - 2 * y + 1; };
    const HeightMap map = sampled(60, 50, 0.01, plane);
    for (const double ratio : {1.02, 1.25, 1.5, 1.9, 2.0, 2.3, 3.0, 3.7, 4.0}) {
        // The coarse grid reaches from border to border.
        const HeightMap coarse = resampled(
            map, grid(static_cast<int>(59 / ratio) + 1, static_cast<int>(49 / ratio) + 1, -0.3, 0.2, 0.01 * ratio));
        int measured = 0;
        for (int row = 0; row < coarse.rows(); ++row)
            for (int column = 0; column < coarse.columns(); ++column)
                if (const double z = coarse.height(column, row); !std::isnan(z)) {
                    EXPECT_NEAR(z, plane(coarse.x(column), coarse.y(row)), 1e-13) << ratio;
                    ++measured;
                }
        EXPECT_GE(measured, (coarse.columns() - 2) * (coarse.rows() - 2)) << ratio;
        // At a ratio of 1.25 nine tenths of the outermost cells lie on the map, and 0.81 of the corners.
        if (ratio == 1.25) {
            EXPECT_EQ(measured, coarse.columns() * coarse.rows() - 1);
        }
    }
}

TEST(Resample, IsThePlainMeanAtWholeRatios) {
    const HeightMap map = sampled(60, 50, 0.01, [](double x, double y) { return std::sin(90 * x) * std::cos(70 * y); });
    // The cells hold three points about a point, or two between points.
    const HeightMap three = resampled(map, grid(10, 8, -0.2, 0.3, 0.03)),
                    two = resampled(map, grid(10, 8, -0.195, 0.305, 0.02));
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 10; ++column) {
            double of_three = 0, of_two = 0;
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i)
                    of_three += map.height(9 + 3 * column + i, 9 + 3 * row + j) / 9;
            for (int j = 0; j < 2; ++j)
                for (int i = 0; i < 2; ++i)
                    of_two += map.height(10 + 2 * column + i, 10 + 2 * row + j) / 4;
            EXPECT_NEAR(three.height(column, row), of_three, 1e-13);
            EXPECT_NEAR(two.height(column, row), of_two, 1e-13);
        }
}

TEST(Resample, IsNotMeasuredBeyondTheMapAndAtGaps) {
    auto map = sampled(60, 50, 0.01, [](double, double) { return 0.5; });
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 20; column < 30; ++column) // -0.1 to -0.01
            map.height(column, row) = not_measured;
    const HeightMap cubic = resampled(map, grid(80, 3, -0.4, 0.4, 0.01));
    for (int column = 0; column < 80; ++column)
        // On the map's own points the gap is as wide as it is.
        EXPECT_EQ(std::isnan(cubic.height(column, 1)), column < 10 || column >= 70 || (column >= 30 && column < 40))
            << column;
    // The cells are four pitches wide about -0.28 + 0.04 k: nine tenths must be there. The gap's own cells end half a
    // pitch off.
    const HeightMap mean = resampled(map, grid(14, 3, -0.28, 0.4, 0.04));
    for (int column = 0; column < 14; ++column) {
        const double x = mean.x(column);
        const bool gap = std::min(x + 0.02, -0.005) - std::max(x - 0.02, -0.105) > 0.1 * 0.04;
        EXPECT_EQ(std::isnan(mean.height(column, 1)), gap) << x;
        if (!gap) {
            EXPECT_DOUBLE_EQ(mean.height(column, 1), 0.5);
        }
    }
}

} // namespace
} // namespace vkfv::surface
