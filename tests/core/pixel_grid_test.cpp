#include "core/mathematics/pixel_grid.hpp"

#include <gtest/gtest.h>

namespace vkfv {
namespace {

TEST(PixelGrid, HasItsMiddleAtTheOrigin) {
    const auto grid = PixelGrid::centred(4, 3, 0.5, 2);
    EXPECT_EQ(grid.x0, -0.75); // between the second and the third column
    EXPECT_EQ(grid.y0, -2);    // the second row
    EXPECT_EQ(grid.pitch_x, 0.5);
    EXPECT_EQ(grid.pitch_y, 2);
    const auto square = PixelGrid::centred(1, 2, 3);
    EXPECT_EQ(square.x0, 0);
    EXPECT_EQ(square.y0, -1.5);
}

} // namespace
} // namespace vkfv
