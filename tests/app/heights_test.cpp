// The heights that a traced stack gives are the specimen's in sign, place and size.
#include "app/program.hpp"
#include "images/image_file.hpp"
#include "support/surface_files.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <vector>

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

// The demo is traced with an eighth of its rays and every other image. Its full form reaches a correlation of 0.95
// before long waves are removed; fewer rays and coarser steps are given a loss of 0.15. The wrong twins are the truth
// mirrored.
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

// With the 10x over a field of 1 mm, the heights of a level surface fall from the axis to the corners. Their
// uncertainty counts this curvature, until a flat (here the stack's own heights) takes it off.
TEST(Heights, OfACurvedFieldAreAsUncertainAsItIs) {
    const auto folder = fresh_folder("curved_field");
    write_file(folder / "c.toml", R"(
[source]
radius_mm = 0.96
wavelength_um = 0.587562
[illumination]
prescription = "koehler"
field_stop_radius_mm = 5.4
[objective]
prescription = "10x_0.28"
[tube_lens]
prescription = "200mm"
[detector]
pixels = 40
size_mm = 10.0
[specimen]
kind = "plane"
size_mm = 1.3
[specimen.reflectance]
kind = "noise"
pitch_um = 4
correlation_length_um = 30.0
mean = 0.5
standard_deviation = 0.2
[specimen.material]
scatter = "lambertian"
[scan]
z_start_um = -80
z_stop_um = 80
z_step_um = 8
[diffraction]
model = "none"
[trace]
rays = 102400
estimator = "backward"
max_bounces = 1
[topography]
focus_measure = "tenengrad"
window_px = 5
)");
    const auto check = run_program({"check", "c.toml", "--json"}, folder);
    ASSERT_EQ(check.exit_code, 0) << check.standard_error;
    const double corner = nlohmann::json::parse(check.standard_output).at("field_curvature_corner_um");
    const auto results_of = [&](const char* out, const std::vector<std::string>& more) {
        std::vector<std::string> arguments = {"stack", "c.toml", "--out", out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = run_program(arguments, folder);
        EXPECT_EQ(result.exit_code, 0) << result.standard_error;
        EXPECT_EQ(result.standard_output.find("A flat takes it off") == std::string::npos, !more.empty());
        return nlohmann::json::parse(read_file(folder / out / "results.json"));
    };
    const auto results = results_of("raw", {});
    // The outermost pixels' middles are at 39/40 of the corner, the middle ones' at half a pixel.
    const double left = results.at("field_curvature_uncorrected_um");
    EXPECT_NEAR(left, corner * (39.0 * 39.0 - 1) / (40.0 * 40.0), 0.02 * corner);
    EXPECT_EQ(results.at("beyond_uncertainty_share"), 0.0);

    const auto heights = surface::read_height_map(folder / "raw/topography.tif");
    const auto uncertainty = surface::read_height_map(folder / "raw/height_uncertainty.tif");
    const auto mean = [](const surface::HeightMap& map, int column, int row) {
        double sum = 0, points = 0;
        for (int j = row - 3; j < row + 3; ++j) {
            for (int i = column - 3; i < column + 3; ++i) {
                if (std::isfinite(map.height(i, j))) {
                    sum += map.height(i, j) * 1e3;
                    ++points;
                }
            }
        }
        return sum / points;
    };
    // The texture decides how far heights follow the curvature. They scatter by 3 um there, and two windows are
    // independent: 2 um. The mean of r^2 over a square is a third of its corner's, and these places have 0.8 of the
    // corner's distance: the uncertainty holds 0.64 - 0.33 of the curvature there.
    for (const int place : {4, 36}) {
        EXPECT_LT(mean(heights, place, place), mean(heights, 20, 20) - 0.5 * left);
        EXPECT_GT(mean(heights, place, 40 - place), mean(heights, 20, 20) - left - 2);
        EXPECT_GT(mean(uncertainty, place, place), 0.3 * left);
    }

    const auto corrected = results_of("flat", {"--set", "topography.flatness_file=raw/topography.tif"});
    EXPECT_FALSE(corrected.contains("field_curvature_uncorrected_um"));
    EXPECT_LT(corrected.at("curves").at("height_uncertainty_um"),
              0.8 * results.at("curves").at("height_uncertainty_um").get<double>());
}

} // namespace vkfv::test
