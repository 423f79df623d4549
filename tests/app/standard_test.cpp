// Standards are traced, measured and compared with their nominal dimensions in results.json, through the real program.
#include "app/program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

namespace vkfv::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// The instrument has NA 0.45, pixels of 1 um in the object, a texture of a micrometre, and 32 paths a pixel.
std::string stack_of(const std::string& specimen, double reach_um) {
    return fmt::format(R"(
[source]
radius_mm = 1.6
wavelength_um = 0.5876
[illumination]
prescription = "koehler"
field_stop_radius_mm = 1.2
[objective]
kind = "ideal"
focal_length_mm = 10.0
numerical_aperture = 0.45
[tube_lens]
kind = "ideal"
focal_length_mm = 200.0
[detector]
pixels = [64, 24]
pixel_um = 20.0
[specimen]
size_mm = 0.1
{0}
[specimen.reflectance]
kind = "noise"
pitch_um = 0.2
correlation_length_um = 1.0
mean = 0.5
standard_deviation = 0.2
[specimen.material]
scatter = "lambertian"
[scan]
z_start_um = -{1}
z_stop_um = {1}
z_step_um = 1.0
[trace]
rays = 49152
estimator = "backward"
max_bounces = 1
[topography]
window_px = 7
)",
                       specimen, reach_um);
}

nlohmann::json dimension(const nlohmann::json& results, const std::string& name) {
    const auto& all = results.at("dimensions");
    const auto found = std::ranges::find_if(all, [&](const auto& one) { return one.at("name") == name; });
    return found == all.end() ? nlohmann::json() : *found;
}

constexpr const char* of_noise = "scatters the heights by";

nlohmann::json results_of(const std::string& kind, const std::string& specimen, double reach_um) {
    const auto folder = fresh_folder("standard_" + kind);
    write_file(folder / "c.toml", stack_of("kind = \"" + kind + "\"\n" + specimen, reach_um));
    const auto result = run_program({"stack", "c.toml", "--out", "out", "--quiet", "--device", "host"}, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_THAT(result.standard_error, Not(HasSubstr(of_noise)));
    return nlohmann::json::parse(read_file(folder / "out/results.json"));
}

// A dimension must lie within four standard errors of what the same window makes of the true heights, and a tenth of a
// step, by which the place of a focus curve depends on what lies around it.
void expect_dimension(const nlohmann::json& results, const std::string& name, double nominal, double seen) {
    const auto one = dimension(results, name);
    ASSERT_TRUE(one.is_object()) << results.at("dimensions");
    EXPECT_EQ(one.at("nominal"), nominal) << name;
    EXPECT_NEAR(one.at("true").get<double>(), nominal, 0.005 * nominal) << name;
    const double standard_error = one.at("standard_error");
    EXPECT_LT(standard_error, 0.02 * nominal) << name;
    EXPECT_NEAR(one.at("measured").get<double>(), seen, std::hypot(4 * standard_error, 0.1)) << name;
}

TEST(Standard, ATracedGrooveHasItsDepthAndWidth) {
    const auto results = results_of("groove", "width_um = 24\ndepth_um = 5\nwall_um = 1", 10);
    expect_dimension(results, "groove depth", 5, 5);
    expect_dimension(results, "groove depth, areal", 5, 5);
    expect_dimension(results, "width at half depth", 24, 24);
}

TEST(Standard, ATracedSphereHasItsRadius) {
    const auto results = results_of("sphere", "representation = \"analytic\"\nradius_um = 120\nheight_um = 6", 10);
    expect_dimension(results, "radius", 120, 120);
    // The sphere's top lies 4 steps from the end of the scan: were it drawn towards the end, the sphere would be 4
    // standard errors too small.
    const auto radius = dimension(results, "radius");
    EXPECT_NEAR(radius.at("measured").get<double>(), 120, 2 * radius.at("standard_error").get<double>());
    EXPECT_LT(dimension(results, "form deviation Sq").at("measured").get<double>(), 0.2);
}

// The mean over a window of 7 um lowers the waves.
TEST(Standard, ATracedSinusoidHasItsPeriodAndWhatTheWindowLeavesOfItsAmplitude) {
    const auto results = results_of("sinusoid", "period_um = 30\namplitude_um = 3", 8);
    const double waves = 7.0 / 30 * std::numbers::pi;
    expect_dimension(results, "amplitude", 3, 3 * std::sin(waves) / waves);
    expect_dimension(results, "period", 30, 30);
}

// A quarter of the rays earns a warning, with how many more of them help.
TEST(Standard, HeightsThatRaysScatterAreWarnedOf) {
    const auto folder = fresh_folder("standard_few_rays");
    write_file(folder / "c.toml", stack_of("kind = \"sinusoid\"\nperiod_um = 30\namplitude_um = 3", 8));
    const auto result =
        run_program({"stack", "c.toml", "--out", "out", "--quiet", "--device", "host", "--rays", "12288"}, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_THAT(result.standard_error, AllOf(HasSubstr(of_noise), HasSubstr("times as many rays (--rays")));
}

} // namespace
} // namespace vkfv::test
