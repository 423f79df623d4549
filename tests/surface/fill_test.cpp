#include "surface/fill.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vkfv::surface {
namespace {

HeightMap plane(int columns, int rows) {
    HeightMap map;
    map.height = Grid<double>(columns, rows);
    map.pitch_x = map.pitch_y = 1;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column)
            map.height(column, row) = 0.3 * column - 0.2 * row + 5;
    return map;
}

// A plane solves Laplace's equation, so gaps inside it end as the plane. Successive over-relaxation by 1.5 in a gap of
// n points multiplies what is left by at most 1 - (pi/(n+1))^2 in each sweep before the best factor, much less for n =
// 7: 200 sweeps leave below (1 - 0.15)^200 = 8e-15 of the start, which is below the plane's extent of 20.
TEST(Fill, GapsInAPlaneAreFilledWithThePlane) {
    const HeightMap whole = plane(40, 30);
    HeightMap map = whole;
    for (int row = 10; row < 17; ++row)
        for (int column = 20; column < 27; ++column)
            map.height(column, row) = std::numeric_limits<double>::quiet_NaN();
    map.height(5, 25) = std::numeric_limits<double>::infinity();
    const HeightMap filled = fill_not_measured(map);
    for (std::size_t k = 0; k < whole.height.values.size(); ++k)
        EXPECT_NEAR(filled.height.values[k], whole.height.values[k], 1e-9) << k;
}

// Laplace's equation has no extremes inside: fills stay between the measured heights, also across the border and in
// gaps far larger than the sweeps reach.
TEST(Fill, StaysBetweenTheMeasuredHeights) {
    HeightMap map = plane(300, 200);
    for (int row = 0; row < 200; ++row)
        for (int column = 0; column < 300; ++column)
            if (row > 2 || column > 4)
                map.height(column, row) = std::numeric_limits<double>::quiet_NaN();
    const HeightMap filled = fill_not_measured(map);
    // Over-relaxation may swing over by what a sweep changes; what the coarse grid leaves is below the measured range.
    const double lowest = 5 - 0.2 * 2, highest = 5 + 0.3 * 4, range = highest - lowest;
    for (const double height : filled.height.values) {
        EXPECT_GE(height, lowest - 0.5 * range);
        EXPECT_LE(height, highest + 0.5 * range);
    }
    EXPECT_EQ(filled.height(2, 1), map.height(2, 1));
}

TEST(Fill, NothingToFillOrToFillFrom) {
    const HeightMap whole = plane(4, 3);
    EXPECT_EQ(fill_not_measured(whole).height.values, whole.height.values);
    HeightMap none = whole;
    for (double& height : none.height.values)
        height = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(fill_not_measured(none).height(0, 0)));
}

} // namespace
} // namespace vkfv::surface
