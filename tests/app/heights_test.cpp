// The heights that a traced stack gives are the specimen's: sign, place and size.
#include "app/program.hpp"
#include "images/image_file.hpp"
#include "support/surface_files.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::test {
namespace {

// Pearson's correlation over the measured points, the truth turned as asked.
double correlation(const surface::HeightMap& measured, const surface::HeightMap& truth, bool turn_x, bool turn_y) {
    double n = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    const int columns = measured.columns(), rows = measured.rows();
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const double x = measured.height(i, j);
            const double y = truth.height(turn_x ? columns - 1 - i : i, turn_y ? rows - 1 - j : j);
            if (std::isfinite(x) && std::isfinite(y)) {
                n += 1;
                a += x;
                b += y;
                aa += x * x;
                bb += y * y;
                ab += x * y;
            }
        }
    }
    return (n * ab - a * b) / std::sqrt((n * aa - a * a) * (n * bb - b * b));
}

} // namespace

// The demo with an eighth of its rays and every other image. Its full form reaches 0.95 before long waves are removed;
// fewer rays and coarser steps are given a loss of 0.15. The wrong twins are the truth mirrored.
TEST(Heights, OfTheDemoAreTheSpecimens) {
    const auto folder = fresh_folder("heights");
    const auto demo = (std::filesystem::path(VKFV_SOURCE_DIR) / "assets/stacks/demo.toml").string();
    const auto result = run_program(
        {"--stack", demo, "--out", "out", "--rays", "1600000", "--quiet", "--set", "scan.z_step_um=1.8"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const auto measured = surface::read_height_map(folder / "out/topography.tif");
    const auto truth = surface::read_height_map(folder / "out/truth.tif");
    EXPECT_GT(correlation(measured, truth, false, false), 0.8);
    EXPECT_LT(correlation(measured, truth, true, false), 0.5);
    EXPECT_LT(correlation(measured, truth, false, true), 0.5);
    EXPECT_LT(correlation(measured, truth, true, true), 0.5);
}

} // namespace vkfv::test
