// The deviation of a measurement, and the share of measured points, by the true surface's local slope.
#pragma once

#include "surface/height_map.hpp"

#include <vector>

namespace vkfv::topography {

// The points whose true slope angle lies in [from, to), radians.
struct SlopeBin {
    double from = 0;
    double to = 0;
    double points = 0;         // number of points of the truth
    double measured_share = 0; // share of these that are measured
    double bias = 0;           // mean deviation, mm; NaN if none is measured
    double rms = 0;            // root mean square deviation about zero, mm; NaN if none is measured
};

// Statistics of the deviation by slope. The slope is that of central differences of the truth, over two pitches: points
// without all four neighbours are left out. `deviation` (measured minus true, NaN where not measured) and `truth` stand
// on the same grid: std::invalid_argument otherwise. Bins go up to the steepest slope, `width` radians wide (positive:
// std::invalid_argument otherwise); empty ones are left out.
std::vector<SlopeBin> deviation_by_slope(const surface::HeightMap& deviation, const surface::HeightMap& truth,
                                         double width);

} // namespace vkfv::topography
