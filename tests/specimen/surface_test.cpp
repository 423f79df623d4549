// A surface file as specimen has its points where they come to stand, levelled, cropped and filled.
#include "images/image_file.hpp"
#include "specimen/description.hpp"
#include "specimen/refined.hpp"
#include "support/surface_files.hpp"
#include "surface_files/surface_file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace vkfv::specimen {
namespace {

class SurfaceSpecimen : public testing::Test {
  protected:
    SurfaceSpecimen()
        : file_(std::filesystem::path(testing::TempDir()) /
                ("vkfv_surface_specimen_" + std::to_string(::getpid()) + ".x3p")) {}
    ~SurfaceSpecimen() override { std::filesystem::remove(file_); }

    HeightField field(const surface::HeightMap& map, const std::function<void(SurfaceFile&)>& change) const {
        surface::write_surface(file_, map);
        SurfaceFile shape{.file = file_};
        change(shape);
        return std::get<HeightField>(make({.shape = shape}).geometry);
    }
    std::filesystem::path file_;
};

// A slope with a bump at (8, 3) of 21 x 11 points, far from the axis and from z = 0.
surface::HeightMap bump() {
    surface::HeightMap map;
    map.height = Grid<double>(21, 11);
    map.x0 = 5;
    map.y0 = -7;
    map.pitch_x = 0.002;
    map.pitch_y = 0.003;
    for (int row = 0; row < 11; ++row)
        for (int column = 0; column < 21; ++column)
            map.height(column, row) = 2 + 1e-3 * column - 5e-4 * row + (column == 8 && row == 3 ? 0.01 : 0);
    return map;
}

TEST_F(SurfaceSpecimen, StandsCentredAndAsItIs) {
    const auto map = bump();
    const HeightField whole = field(map, [](SurfaceFile& d) { d.level = false; });
    EXPECT_EQ(whole.heights.columns, 21);
    EXPECT_NEAR(whole.x_min, -0.02, 1e-12);
    EXPECT_NEAR(whole.x_max(), 0.02, 1e-12);
    EXPECT_NEAR(whole.y_max(), 0.015, 1e-12);
    EXPECT_TRUE(whole.interpolated.empty());
    for (std::size_t k = 0; k < map.height.values.size(); ++k)
        EXPECT_EQ(whole.heights.values[k], static_cast<float>(map.height.values[k]));
}

TEST_F(SurfaceSpecimen, IsLevelledByLeastSquares) {
    const HeightField levelled = field(bump(), [](SurfaceFile&) {});
    double sum = 0, moment_x = 0, moment_y = 0;
    for (int row = 0; row < 11; ++row)
        for (int column = 0; column < 21; ++column) {
            const double z = static_cast<double>(levelled.heights(column, row));
            sum += z;
            moment_x += z * (column - 10);
            moment_y += z * (row - 5);
        }
    // The rounding is that of 231 float32 heights below 0.01 mm, each off by at most 2^-25 of it, with arms of up to 10
    // points.
    const double rounding = 231 * std::ldexp(0.01, -25);
    EXPECT_NEAR(sum, 0, rounding);
    EXPECT_NEAR(moment_x, 0, 10 * rounding);
    EXPECT_NEAR(moment_y, 0, 10 * rounding);
    EXPECT_GT(levelled.heights(8, 3), 0.009f);
}

TEST_F(SurfaceSpecimen, IsCroppedAroundItsCentre) {
    const auto map = bump();
    const HeightField part = field(map, [](SurfaceFile& d) {
        d.size = 0.012;
        d.level = false;
    });
    ASSERT_EQ(part.heights.columns, 7);
    ASSERT_EQ(part.heights.rows, 5);
    EXPECT_NEAR(part.x_min, -0.006, 1e-12);
    EXPECT_NEAR(part.y_min, -0.006, 1e-12);
    EXPECT_EQ(part.heights(0, 0), static_cast<float>(map.height(7, 3)));
    EXPECT_EQ(part.heights(1, 0), static_cast<float>(map.height(8, 3))) << "the bump";
    EXPECT_THROW(field(map, [](SurfaceFile& d) { d.size = 0.031; }), InputError);
}

// A gap is filled for the trace, and unknown to the truth wherever a facet has one of its corners.
TEST_F(SurfaceSpecimen, GapsAreTracedButNotTrue) {
    auto map = bump();
    map.height(8, 3) = 2.0065;
    const auto whole = map;
    map.height(12, 6) = std::numeric_limits<double>::quiet_NaN();
    const HeightField filled = field(map, [](SurfaceFile& d) { d.level = false; });
    // The slope continues through the gap: it solves Laplace's equation; float32 of 2 mm.
    EXPECT_NEAR(filled.heights(12, 6), whole.height(12, 6), 2.5e-7);
    const surface::HeightMap true_heights = truth({filled, {}}, 40, 20, -0.0195, -0.0095, 0.001, 0.001);
    for (int row = 0; row < 20; ++row)
        for (int column = 0; column < 40; ++column) {
            // Six facets surround (12, 6), which stands at (0.004, 0.003): in whole pitches from there the hexagon with
            // -1 < u, v, u - v < 1. Pixels clearly outside are known, those clearly inside are not.
            const double u = (true_heights.x(column) - 0.004) / 0.002, v = (true_heights.y(row) - 0.003) / 0.003;
            const double distance = std::max({std::abs(u), std::abs(v), std::abs(u - v)});
            if (distance < 0.6) {
                EXPECT_TRUE(std::isnan(true_heights.height(column, row))) << column << " " << row;
            }
            if (distance > 1.5) {
                EXPECT_FALSE(std::isnan(true_heights.height(column, row))) << column << " " << row;
            }
        }
}

TEST_F(SurfaceSpecimen, ImagesOfHeightsTakePitchAndUnit) {
    const auto file = std::filesystem::path(file_).replace_extension(".tif");
    Grid<float> values(3, 2);
    values.values = {0, 1, 2, 3, 4, 5};
    surface::write_tiff(file, values);
    SurfaceFile shape{.file = file};
    EXPECT_THROW((void)make({.shape = shape}), InputError);
    shape.pitch = 0.5;
    shape.unit = 1e-3;
    shape.level = false;
    const auto field = std::get<HeightField>(make({.shape = shape}).geometry);
    EXPECT_EQ(field.pitch_x, 0.5);
    EXPECT_EQ(field.heights(2, 1), 5e-3f);
    std::filesystem::remove(file);
}

TEST_F(SurfaceSpecimen, NothingMeasuredIsRefused) {
    auto map = bump();
    for (double& z : map.height.values)
        z = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(field(map, [](SurfaceFile&) {}), InputError);
}

// A file's points may lie further apart than the roughness needs them.
TEST(RefinedField, KeepsTheSurfaceAndItsGaps) {
    HeightField coarse{
        .heights = Grid<float>(41, 41), .x_min = -0.02, .y_min = -0.02, .pitch_x = 0.001, .pitch_y = 0.001};
    for (int row = 0; row < 41; ++row)
        for (int column = 0; column < 41; ++column)
            coarse.heights(column, row) = static_cast<float>(0.002 * std::sin(2 * M_PI * (column - 20) / 16.0));
    coarse.interpolated.assign(41 * 41, false);
    coarse.interpolated[coarse.heights.index(20, 20)] = true;
    const HeightField fine = refined(coarse, 0.0003, {});
    EXPECT_EQ(fine.heights.columns, 134); // 0.04 / 0.0003 = 133.3 cells
    EXPECT_NEAR(fine.x_min + fine.x_max(), 0, 1e-15);
    double worst = 0;
    for (int column = 5; column < 129; ++column)
        worst = std::max(worst, std::abs(static_cast<double>(fine.heights(column, 60)) -
                                         0.002 * std::sin(2 * M_PI * (fine.x_min + column * 0.0003) / 0.016)));
    // Keys' cubic convolution errs by about (pi p / l)^3 of the amplitude at a wavelength l: 0.0076 here.
    EXPECT_LT(worst, 0.002 * 0.0076);
    const auto gaps = std::count(fine.interpolated.begin(), fine.interpolated.end(), true);
    EXPECT_GE(gaps, 9); // a square of one pitch, 3.3 of the fine ones
    EXPECT_LE(gaps, 16);
}

} // namespace
} // namespace vkfv::specimen
