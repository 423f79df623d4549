// In stacks of displaced instruments, through the real program, measured heights lie where the truth has them.
#include "app/program.hpp"
#include "core/mathematics/units.hpp"
#include "support/surface_files.hpp"

#include <glm/glm.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::test {
namespace {

// The instrument has NA 0.45, pixels of 1 um in the object, a texture of a micrometre, and 32 paths a pixel.
const std::string microscope = R"(
[source]
radius_mm = 1.6
wavelength_um = 0.5876
[illumination]
prescription = "koehler"
field_stop_radius_mm = 1.5
[objective]
kind = "ideal"
focal_length_mm = 10.0
numerical_aperture = 0.45
[tube_lens]
kind = "ideal"
focal_length_mm = 200.0
[detector]
pixels = [48, 40]
pixel_um = 20.0
[specimen]
size_mm = 0.16
SPECIMEN
[specimen.reflectance]
kind = "noise"
pitch_um = 0.2
correlation_length_um = 1.0
mean = 0.5
standard_deviation = 0.2
[specimen.material]
scatter = "lambertian"
[scan]
z_start_um = -5.0
z_stop_um = 5.0
z_step_um = 1.0
[trace]
rays = 61440
estimator = "backward"
max_bounces = 1
[topography]
window_px = 7
)";

struct Measured {
    surface::HeightMap heights, truth;
    nlohmann::json results;
};

Measured measured(const std::string& name, const std::string& specimen, const std::vector<std::string>& settings) {
    const auto folder = fresh_folder(name);
    write_file(folder / "c.toml", replaced(microscope, "SPECIMEN", specimen));
    std::vector<std::string> words = {"stack", "c.toml", "--out", "out", "--quiet", "--device", "host"};
    for (const auto& setting : settings) {
        words.insert(words.end(), {"--set", setting});
    }
    const auto result = run_program(words, folder);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    return {.heights = surface::read_height_map(folder / "out/topography.tif"),
            .truth = surface::read_height_map(folder / "out/truth.tif"),
            .results = nlohmann::json::parse(read_file(folder / "out/results.json"))};
}

// By how many pixels the measured heights lie aside of the true ones, to first order: a least-squares fit of
//   measured = a + b x + c y + g (truth - s . gradient of truth).
glm::dvec2 aside(const Measured& stack) {
    constexpr int terms = 6;
    std::array<std::array<double, terms + 1>, terms> normal{};
    for (int row = 1; row + 1 < stack.truth.rows(); ++row) {
        for (int column = 1; column + 1 < stack.truth.columns(); ++column) {
            const auto& t = stack.truth.height;
            const double height = stack.heights.height(column, row);
            const double along = 0.5 * (t(column + 1, row) - t(column - 1, row));
            const double across = 0.5 * (t(column, row + 1) - t(column, row - 1));
            const std::array<double, terms + 1> values = {
                1, column / 20.0 - 1, row / 20.0 - 1, t(column, row), along, across, height};
            if (!std::isfinite(height) || !std::isfinite(t(column, row) + along + across)) {
                continue;
            }
            for (std::size_t i = 0; i < terms; ++i) {
                for (std::size_t j = 0; j <= terms; ++j) {
                    normal[i][j] += values[i] * values[j];
                }
            }
        }
    }
    for (std::size_t i = 0; i < terms; ++i) { // positive definite: no pivots
        for (std::size_t k = 0; k < terms; ++k) {
            const double factor = k == i ? 0 : normal[k][i] / normal[i][i];
            for (std::size_t j = i; j <= terms; ++j) {
                normal[k][j] -= factor * normal[i][j];
            }
        }
    }
    const auto solved = [&](std::size_t i) { return normal[i][terms] / normal[i][i]; };
    return {-solved(4) / solved(3), -solved(5) / solved(3)};
}

// The largest distance in pixels. The noise of so few rays scatters what aside() finds by 0.1 to 0.2; the mapping
// itself is held to a hundredth in tests/optics.
constexpr double most_aside = 0.4;

const std::string waves = "kind = \"cross-sinusoid\"\namplitude_um = 1.5\nperiod_um = 24.0";

// The waves under the instrument as it is, measured once for several tests.
const Measured& centred() {
    static const auto stack = measured("centred", waves, {});
    return stack;
}

// `shift` is that of the pixels on the specimen in um. It is up to half a wave, so heights would not correlate with the
// truth of other places.
void expect_registered(const std::string& name, const Measured& stack, glm::dvec2 shift) {
    EXPECT_LT(glm::length(aside(stack)), most_aside) << name;
    EXPECT_GT(stack.results.at("correlation"), 0.95) << name;
    const auto& mapping = stack.results.at("mapping");
    EXPECT_NEAR(mapping.at("shift_x_um"), shift.x, 0.02) << name;
    EXPECT_NEAR(mapping.at("shift_y_um"), shift.y, 0.02) << name;
    EXPECT_LT(mapping.at("interpolation_error_um"), 0.001) << name;
    // The maps' middle lies at the shift that the results tell.
    const auto& map = stack.truth;
    EXPECT_NEAR(1e3 * 0.5 * (map.x(0) + map.x(map.columns() - 1)), mapping.at("shift_x_um"), 1e-3) << name;
    EXPECT_NEAR(1e3 * 0.5 * (map.y(0) + map.y(map.rows() - 1)), mapping.at("shift_y_um"), 1e-3) << name;
}

TEST(PixelPlaces, OfACentredInstrument) {
    expect_registered("centred", centred(), {0, 0});
}

// The image is 20 times as large and turned by half a turn.
TEST(PixelPlaces, OfADisplacedDetector) {
    const auto stack = measured("detector", waves, {"detector.decentre_x_mm=0.24", "detector.decentre_y_mm=-0.1"});
    expect_registered("detector", stack, {-12, 5});
}

TEST(PixelPlaces, OfADisplacedObjective) {
    const auto stack = measured("objective", waves, {"objective.decentre_x_mm=-0.01", "objective.decentre_y_mm=0.012"});
    expect_registered("objective", stack, {-10, 12});
}

// The slope of the least-squares line through (change of the truth, change of the heights) from one stack to another.
double followed(const Measured& from, const Measured& to) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t k = 0; k < from.truth.height.values.size(); ++k) {
        const double along = to.truth.height.values[k] - from.truth.height.values[k];
        const double up = to.heights.height.values[k] - from.heights.height.values[k];
        if (std::isfinite(along + up)) {
            n += 1;
            x += along;
            y += up;
            xx += along * along;
            xy += along * up;
        }
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

// Corners that the lenses see 31 um from the axis are recorded 8 % nearer to it, columns lean by 3 degrees, and the
// magnification falls by 4 % from one end of the scan to the other. The truth of the pixels changes by that, and the
// heights follow it as the window of 7 pixels lets them: by sinc(7 / 24) along both axes of waves of 24 um. Errors by
// the texture are common to both stacks. What is left, 0.19 um beside changes of 0.32 um, over 39 windows gives the
// slope a standard error of 0.09; the bound is three of it. Heights where the lenses alone look would not follow at
// all.
TEST(PixelPlaces, OfADistortedImage) {
    const auto& plain = centred();
    const auto stack = measured("distorted", waves,
                                {"detector.distortion=-8", "detector.distortion_field_mm=0.031", "detector.shear_deg=3",
                                 "objective.magnification_per_um=-0.004"});
    EXPECT_LT(glm::length(aside(stack)), most_aside);
    EXPECT_GT(stack.results.at("correlation"), 0.95);
    const double phase = pi * 7 / 24, transfer = std::sin(phase) / phase;
    EXPECT_NEAR(followed(plain, stack), transfer * transfer, 0.28);
    // An affine fit finds the shear and 2 d (<x^2> + <y^2>) of it besides, 3.17 degrees for d of -0.08 / (0.031 mm)^2,
    // and some 2 % by the second order in the distortion.
    EXPECT_NEAR(stack.results.at("mapping").at("perpendicularity_deg"), 3.17, 0.1);
}

// The specimen moves by 0.2 um from image to image, so that points in focus in the middle of the scan lie 1 um aside.
TEST(PixelPlaces, OfASpecimenThatDrifts) {
    const auto stack = measured("drift", waves, {"stage.lateral_drift_um_per_s=[0.4, 0.0]", "stage.interval_s=0.5"});
    EXPECT_LT(glm::length(aside(stack)), most_aside);
    EXPECT_GT(stack.results.at("correlation"), 0.95);
    EXPECT_NEAR(stack.results.at("mapping").at("shift_x_um"), -1, 0.1);
}

// The regions of a step lie where it is seen, and its true height is that of the specimen.
TEST(PixelPlaces, TakeTheRegionsOfAStandardAlong) {
    const auto stack = measured("step", "kind = \"step\"\nheight_um = 4.0",
                                {"detector.decentre_x_mm=0.2", "topography.form=\"truth\""});
    const auto& step = stack.results.at("dimensions").at(0);
    EXPECT_NEAR(step.at("true"), 4, 0.01);
    EXPECT_NEAR(step.at("error"), 0, 0.3);
}

} // namespace
} // namespace vkfv::test
