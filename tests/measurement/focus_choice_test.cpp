// A stack of vkfv's own gets its focus measure by its configuration alone, before there are images.
#include "configuration/configuration.hpp"
#include "measurement/scene/assembly.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

namespace vkfv::measurement {
namespace {

topography::FocusMeasure measure_of(const char* stack, const std::vector<TomlOverride>& overrides = {}) {
    const auto configuration =
        load_configuration(std::filesystem::path(VKFV_SOURCE_DIR) / "assets/stacks" / stack, overrides);
    return evaluation_options(configuration, assemble_instrument(configuration)).focus_measure.value();
}

TEST(FocusChoice, IsByTheConfigurationOfOwnStacks) {
    using enum topography::FocusMeasure;
    EXPECT_EQ(measure_of("camera.toml"), gradient_and_curvature);
    EXPECT_EQ(measure_of("plane.toml"), wavelet); // no camera
    EXPECT_EQ(measure_of("plane.toml", {{"topography.focus_measure", "\"auto\"", ""}}), wavelet);
    EXPECT_EQ(measure_of("plane.toml", {{"topography.focus_measure", "\"brenner\"", ""}}), brenner);
    EXPECT_EQ(measure_of("own_microscope.toml"), modified_laplacian); // the file names this measure
}

} // namespace
} // namespace vkfv::measurement
