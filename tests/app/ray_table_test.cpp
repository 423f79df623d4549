#include "measurement/image/ray_table.hpp"

#include "app/program.hpp"
#include "core/messages/error.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::measurement {
namespace {

std::vector<trace::RayInput> read(const std::string& text) {
    const auto file = test::fresh_folder("ray_table") / "rays.csv";
    test::write_file(file, text);
    return read_ray_table(file);
}

TEST(RayTable, ReadsNumbersBitByBit) {
    const auto rays = read("x_mm, y_mm, z_mm, l, m, n\r\n"
                           "-0.19933749145922294, +0.5,-1e-3,0,0,1\r\n"
                           "\n"
                           "1,2,3,0.6,0,0.8");
    ASSERT_EQ(rays.size(), 2u);
    EXPECT_EQ(rays[0].x, -0.19933749145922294);
    EXPECT_EQ(rays[0].y, 0.5);
    EXPECT_EQ(rays[0].z, -1e-3);
    EXPECT_EQ(rays[0].n, 1);
    EXPECT_EQ(rays[1].z, 3);
    // 0.6 and 0.8 are not exact, and neither is their length: normalising moves them by roundings of 1.1e-16.
    EXPECT_NEAR(rays[1].l, 0.6, 2.2e-16);
}

TEST(RayTable, WritesEnoughDigitsToReadBack) {
    const double third = 1.0 / 3;
    const trace::TracedRay ray{third, -third, 0, 0, 1, 345.44180682537205, "ok"};
    const auto text = ray_table_text(std::span(&ray, 1), "paraxial");
    EXPECT_EQ(text, "x_mm,y_mm,l,m,n,opl_mm,status,z_origin\n"
                    "0.33333333333333331,-0.33333333333333331,0,0,1,345.44180682537205,ok,paraxial\n");
    EXPECT_EQ(std::stod(text.substr(text.find('\n') + 1)), third);
}

} // namespace
} // namespace vkfv::measurement
