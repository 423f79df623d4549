// The truth stands where the instrument believes its pixels to look.
#include "configuration/configuration.hpp"
#include "core/mathematics/units.hpp"
#include "measurement/judgement/plan_warnings.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/surface/standard.hpp"
#include "specimen/kinds.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::measurement {
namespace {

Configuration microscope_with_groove(const std::string& assumed_pitch_um) {
    std::vector<TomlOverride> overrides;
    if (!assumed_pitch_um.empty()) {
        overrides.push_back({"detector.assumed_pitch_um", assumed_pitch_um, "test"});
    }
    return load_configuration(std::filesystem::path(VKFV_SOURCE_DIR) / "assets/stacks/groove_budget.toml", overrides);
}

struct Seen {
    KnownTruth truth;
    std::vector<StandardDimension> dimensions; // of an instrument whose heights are the true ones
    std::vector<Warning> warnings;
};

Seen seen_by(const Configuration& configuration) {
    const auto specimen = make_specimen(configuration);
    const auto instrument = assemble_for_figures(configuration);
    Seen seen{.truth = truth_on_pixels(instrument, configuration, specimen), .dimensions = {}, .warnings = {}};
    seen.dimensions =
        standard_dimensions(*specimen::feature_of(*configuration.specimen), seen.truth.heights, seen.truth.undistorted);
    seen.warnings = plan_warnings(
        configuration, instrument,
        relief_of(specimen, configuration.instrument.detector_pixels, instrument.first_order.pixel_pitch));
    return seen;
}

double error_of(const Seen& seen, const std::string& name) {
    for (const auto& dimension : seen.dimensions) {
        if (const auto row = dimension.in_unit(); row.name == name) {
            return row.measured / row.truth - 1;
        }
    }
    return surface::undefined;
}

// Pixels of 0.345 um that the instrument takes for 1 % larger: the same heights, and every length in x and y 1 % too
// long.
TEST(KnownTruth, AnAssumedPitchStretchesLengthsAndNotHeights) {
    const auto believed = seen_by(microscope_with_groove("0.34845")), known = seen_by(microscope_with_groove(""));
    EXPECT_NEAR(known.truth.heights.pitch_x, 0.345e-3, 1e-12);
    EXPECT_NEAR(believed.truth.heights.pitch_x / known.truth.heights.pitch_x, 1.01, 1e-9);
    EXPECT_NEAR(believed.truth.heights.x0 / known.truth.heights.x0, 1.01, 1e-6);
    EXPECT_EQ(believed.truth.heights.height.values, known.truth.heights.height.values);
    EXPECT_NEAR(believed.truth.mapping.amplification.x / known.truth.mapping.amplification.x, 1.01, 1e-9);
    EXPECT_NEAR(error_of(believed, "width at half depth"), 0.01, 2e-3);
    EXPECT_NEAR(error_of(known, "width at half depth"), 0, 1e-3);
    EXPECT_NEAR(error_of(believed, "groove depth"), 0, 2e-3);
    EXPECT_TRUE(believed.warnings.empty()) << believed.warnings.front().sentence;
}

TEST(KnownTruth, AnAssumedPitchFarFromTheTrueOneIsWarnedOf) {
    const auto wrong = seen_by(microscope_with_groove("0.69"));
    ASSERT_EQ(wrong.warnings.size(), 1u);
    EXPECT_EQ(wrong.warnings.front().code, "assumed-pitch");
    EXPECT_EQ(wrong.warnings.front().works, "0.345");
}

// Where the magnification follows the focal plane, a pixel looks nearer to the axis the higher the point is that it
// sees in focus: the height solves z = A sin(2 pi x / P) at x = nominal / (1 + rate (z - focus)).
TEST(KnownTruth, AMagnificationThatFollowsTheFocalPlaneMovesHighPointsInwards) {
    constexpr double rate = 0.005, amplitude = 3, period = 64; // 1/um; um as in the example
    const auto configuration =
        load_configuration(std::filesystem::path(VKFV_SOURCE_DIR) / "assets/stacks/sinusoid.toml",
                           {{"objective.magnification_per_um", fmt::format("{}", rate), "test"},
                            {"specimen.roughness.noise_um", "0.001", "test"}});
    const auto specimen = make_specimen(configuration);
    const auto instrument = assemble_for_figures(configuration);
    const auto truth = truth_on_pixels(instrument, configuration, specimen);
    const optics::PixelMapping mapping(configuration.instrument, instrument);
    const auto nominal =
        PixelGrid::centred(configuration.instrument.detector_pixels, instrument.first_order.pixel_pitch);
    double most_aside = 0;
    for (int column = 0; column < nominal.columns; column += 5) {
        const int row = nominal.rows / 3;
        const glm::dvec2 at(nominal.x0 + column * nominal.pitch_x, nominal.y0 + row * nominal.pitch_y);
        const double height = 1e3 * truth.heights.height(column, row);
        const double scale = 1 + rate * (height - 1e3 * mapping.focus(at));
        EXPECT_NEAR(height, amplitude * std::sin(2 * pi * 1e3 * mapping.place(at, scale).x / period), 0.01);
        const double unmoved = amplitude * std::sin(2 * pi * 1e3 * mapping.place(at).x / period);
        most_aside = std::max(most_aside, std::abs(height - unmoved));
    }
    EXPECT_GT(most_aside, 0.1); // wrong twin: the magnification at z = 0
}

} // namespace
} // namespace vkfv::measurement
