// How a measurement's deviation, and whether there is one, depend on the true surface's local slope.
#pragma once

#include "surface/height_map.hpp"

#include <vector>

namespace vkfv::topography {

// All points whose true slope angle lies in [from, to), radians.
struct SlopeBin {
    double from = 0;
    double to = 0;
    double points = 0;         // of the truth
    double measured_share = 0; // of these
    double bias = 0;           // mean deviation, mm; NaN where none is measured
    double rms = 0;            // of the deviation about zero, mm; likewise
};

// The slope is that of central differences of the truth, over two pitches: points without all four neighbours are left
// out. `deviation` (measured less true, NaN where not measured) and `truth` stand on the same grid:
// std::invalid_argument otherwise. Bins up to the steepest, `width` radians wide (positive: std::invalid_argument
// otherwise); empty ones are left out.
std::vector<SlopeBin> deviation_by_slope(const surface::HeightMap& deviation, const surface::HeightMap& truth,
                                         double width);

} // namespace vkfv::topography
