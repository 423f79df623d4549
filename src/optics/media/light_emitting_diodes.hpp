// Light-emitting diodes by the name of their colour.
#pragma once

#include "optics/media/spectrum.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace vkfv::optics {

// Typical values, as data sheets state them: of a diode of a given maker they are its own.
struct LedColour {
    std::string_view name;
    double peak_um = 0;       // wavelength of the largest flux per wavelength
    double full_width_um = 0; // of the spectrum at half its maximum; 0: white, no bell
};
std::span<const LedColour> led_colours();

// A bell of this peak and width; of white a blue die of 450 nm with phosphor, by points.
Spectrum spectrum_of(const LedColour& colour);

} // namespace vkfv::optics
