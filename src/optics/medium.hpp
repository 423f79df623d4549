// Optical media and their dispersion.
#pragma once

#include <string>
#include <vector>

namespace vkfv::optics {

// A medium between surfaces: indices at stated wavelengths, and between them the Cauchy formula
// n = A + B / lambda^2 + C / lambda^4 through the three nearest (one: constant, two: A and B).
struct Medium {
    std::string name;                   // "air", "N-BK7", ...; as the source names it
    std::vector<double> wavelengths_um; // ascending; empty, with one index: the same at every wavelength
    std::vector<double> indices;

    static Medium air(); // index 1: indices are relative to air

    // Throws InputError (naming medium and wavelength) outside the tabulated range widened by 10 nm.
    double index(double wavelength_um) const;
};

} // namespace vkfv::optics
