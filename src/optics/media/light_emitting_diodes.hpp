// Light-emitting diodes by the name of their colour.
#pragma once

#include "optics/media/spectrum.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace vkfv::optics {

// A colour by which diodes are sold, with a usual peak and width: round numbers that stand for no maker's diode. Where
// its data sheet is at hand, its own peak and width are the ones to take.
struct LedColour {
    std::string_view name;
    double peak_um = 0;       // wavelength of the largest flux per wavelength
    double full_width_um = 0; // of the spectrum at half its maximum; 0: white, no bell
};
std::span<const LedColour> led_colours();

// A bell of this peak and width; of white a blue die of 450 nm with phosphor, by points.
Spectrum spectrum_of(const LedColour& colour);

} // namespace vkfv::optics
