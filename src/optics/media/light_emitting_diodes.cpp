#include "optics/media/light_emitting_diodes.hpp"

#include <array>

namespace vkfv::optics {

namespace {

constexpr std::array all_colours = {
    LedColour{"ultraviolet", 0.385, 0.012}, LedColour{"royal-blue", 0.455, 0.018}, LedColour{"blue", 0.470, 0.025},
    LedColour{"cyan", 0.505, 0.030},        LedColour{"green", 0.530, 0.035},      LedColour{"amber", 0.590, 0.018},
    LedColour{"red", 0.625, 0.018},         LedColour{"deep-red", 0.660, 0.020},   LedColour{"infrared", 0.850, 0.030},
    LedColour{"white", 0.450, 0},
};

// The spectrum of assets/stacks/white_led.toml: a blue die with phosphor.
const std::vector<double> white_wavelengths_um = {0.40, 0.43, 0.44, 0.45, 0.46, 0.48,
                                                  0.50, 0.53, 0.56, 0.60, 0.65, 0.70};
const std::vector<double> white_densities = {0.00, 0.20, 0.65, 1.00, 0.50, 0.12, 0.25, 0.55, 0.62, 0.50, 0.20, 0.05};

} // namespace

std::span<const LedColour> led_colours() {
    return all_colours;
}

Spectrum spectrum_of(const LedColour& colour) {
    return colour.full_width_um > 0 ? Spectrum::gaussian(colour.peak_um, colour.full_width_um)
                                    : Spectrum::table(white_wavelengths_um, white_densities);
}

} // namespace vkfv::optics
