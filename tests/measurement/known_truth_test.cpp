// The truth stands where the instrument believes its pixels to look.
#include "configuration/configuration.hpp"
#include "measurement/judgement/plan_warnings.hpp"
#include "measurement/scene/assembly.hpp"
#include "measurement/scene/known_truth.hpp"
#include "measurement/surface/standard.hpp"
#include "specimen/kinds.hpp"

#include <gtest/gtest.h>

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

} // namespace
} // namespace vkfv::measurement
