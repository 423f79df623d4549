// A stack whose images of waves do not hold says so wherever its heights are read: in the log, the results and the
// report.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace vkfv::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// The specimen is a mirror with waves of 50 nm amplitude: below lambda / (4 pi) = 44 nm of standard deviation.
constexpr const char* mirror_stack = R"([source]
radius_mm = 1.3
wavelength_um = 0.55

[illumination]
kind = "ideal"
condenser_focal_length_mm = 30.0
field_stop_radius_mm = 0.6

[objective]
kind = "ideal"
focal_length_mm = 15.0
numerical_aperture = 0.4

[tube_lens]
kind = "ideal"
focal_length_mm = 200.0

[detector]
pixels = 32
pixel_um = 6.0

[specimen]
kind = "sinusoid"
size_mm = 0.03
amplitude_um = 0.05
period_um = 4.0
pitch_um = 0.25

[specimen.material]
scatter = "mirror"

[scan]
z_start_um = -6.0
z_stop_um = 6.0
z_step_um = 1.2

[trace]
rays = 131072
estimator = "backward"

[diffraction]
model = "waves"
cells = 8
parts_per_pixel = 2
)";

// The depth of field lambda / NA^2 in um.
constexpr double depth_of_field_um = 0.55 / (0.4 * 0.4);

void expect_honest_heights(const nlohmann::json& results) {
    EXPECT_GE(results["curves"]["height_uncertainty_um"].get<double>(), (1 - 1e-6) * depth_of_field_um);
    ASSERT_FALSE(results["dimensions"].empty());
    for (const auto& dimension : results["dimensions"]) {
        EXPECT_TRUE(dimension["standard_error"].is_null()) << dimension;
    }
}

} // namespace

TEST(MirrorStack, IsWarnedOfWhereverItsHeightsAreRead) {
    const auto folder = fresh_folder("mirror_stack");
    write_file(folder / "c.toml", mirror_stack);
    const auto told = HasSubstr("changes the light's phase alone");
    const auto run = run_program({"stack", "c.toml", "--out", "stack"}, folder);
    ASSERT_EQ(run.exit_code, 0) << run.standard_error;
    EXPECT_THAT(run.standard_error, told);
    const auto results = nlohmann::json::parse(read_file(folder / "stack/results.json"));
    EXPECT_NEAR(results["waves"]["hidden_height_uncertainty_um"], depth_of_field_um, 1e-6 * depth_of_field_um);
    EXPECT_THAT(results["warnings"].dump(), told);
    expect_honest_heights(results);
    EXPECT_THAT(read_file(folder / "stack/report.html"), HasSubstr("Warning: Images of waves do not hold here"));
    const auto again = run_program({"topography", "stack", "--out", "again"}, folder);
    ASSERT_EQ(again.exit_code, 0) << again.standard_error;
    EXPECT_THAT(again.standard_error, told);
    const auto evaluated = nlohmann::json::parse(read_file(folder / "again/results.json"));
    EXPECT_NEAR(evaluated["curves"]["height_uncertainty_um"].get<double>(),
                results["curves"]["height_uncertainty_um"].get<double>(), 1e-9);
}

TEST(MirrorStack, AlikeOneThatScattersIsNotWarnedOf) {
    const auto folder = fresh_folder("diffuse_stack");
    write_file(folder / "c.toml", mirror_stack);
    const auto mirror = run_program({"check", "c.toml", "--all"}, folder);
    EXPECT_THAT(mirror.standard_output, AllOf(HasSubstr("changes the light's phase alone"),
                                              HasSubstr("wave_scatter_fill"), HasSubstr("wave_texture_um")));
    const auto diffuse =
        run_program({"check", "c.toml", "--all", "--set", "specimen.material.scatter=lambertian"}, folder);
    EXPECT_THAT(diffuse.standard_output, AllOf(HasSubstr("wave_scatter_fill"), Not(HasSubstr("do not hold"))));
    const auto narrow = run_program({"check", "c.toml", "--set", "source.radius_mm=0.4"}, folder);
    EXPECT_THAT(narrow.standard_output, HasSubstr("spread unevenly over the objective's pupil"));
}

} // namespace vkfv::test
