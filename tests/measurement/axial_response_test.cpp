// The average along z that a stack of its own is given follows from how fast waves fade with defocus.
#include "configuration/configuration.hpp"
#include "core/mathematics/units.hpp"
#include "measurement/scene/assembly.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>

namespace vkfv::measurement {
namespace {

// The full width at half maximum of the response along z, by the scalar Debye integral at a wavelength of 0.55 um, of a
// wave of this share of the cutoff.
struct AxialResponse {
    double aperture, share, full_width; // um
};
constexpr std::array responses = {AxialResponse{0.28, 0.25, 13.2}, AxialResponse{0.28, 0.5, 10.0},
                                  AxialResponse{0.66, 0.25, 2.15}, AxialResponse{0.66, 0.5, 1.63}};

// The half width in um that vkfv assumes, from the standard deviation in steps of the stack's average along z: of an
// ideal lens, with four pixels to the wave of this share of the cutoff.
double half_width(double aperture, double share, const char* model) {
    constexpr int pixels = 64;
    const double wave = 0.55 / (2 * aperture * share), step = 0.05 * wave; // um
    const auto configuration =
        load_configuration(std::filesystem::path(VKFV_SOURCE_DIR) / "assets/stacks/ideal_lenses.toml",
                           {{"objective.numerical_aperture", fmt::format("{}", aperture), ""},
                            {"source.wavelength_um", "0.55", ""},
                            {"detector.pixels", fmt::format("{}", pixels), ""},
                            {"detector.size_mm", fmt::format("{}", 10 * pixels * wave / 4 / um_per_mm), ""},
                            {"scan.z_start_um", "0.0", ""},
                            {"scan.z_stop_um", fmt::format("{}", 1000 * step), ""},
                            {"scan.z_step_um", fmt::format("{}", step), ""},
                            {"diffraction.model", fmt::format("\"{}\"", model), ""}});
    const auto options = evaluation_options(configuration, assemble_instrument(configuration));
    constexpr double of_width = topography::most_smoothing_of_width, deviations_a_half_width = 1.177;
    return options.smoothing_steps.value() / of_width * deviations_a_half_width * step;
}

TEST(AxialResponse, OfWavesSetsTheAverageAlongZ) {
    for (const auto& [aperture, share, full_width] : responses) {
        const double waves = half_width(aperture, share, "waves"), rays = half_width(aperture, share, "none");
        EXPECT_NEAR(waves, full_width / 2, 0.06 * full_width / 2) << aperture << " " << share;
        EXPECT_LT(rays, 0.75 * full_width / 2) << aperture << " " << share; // the wrong twin
    }
    // Finer waves than half the cutoff fade no sooner.
    EXPECT_NEAR(half_width(0.28, 0.75, "waves"), 5.0, 0.06 * 5.0);
}

} // namespace
} // namespace vkfv::measurement
