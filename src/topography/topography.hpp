// From a focus stack to a height map, and from two height maps to their deviation.
#pragma once

#include "core/grid.hpp"
#include "surface/height_map.hpp"

#include <span>
#include <string>

namespace vkfv::topography {

struct TopographyOptions {
    std::string focus_measure = "standard-deviation"; // or "modified-laplacian"
    int window_px = 7;                                // odd
    std::string peak = "gaussian";
};

struct Topography {
    surface::HeightMap height; // NaN: not measured
    Grid<double> quality;      // peak over median of the focus measure along z; dimensionless
};

// stack[k] is the image at z[k] (mm, ascending, equidistant); pixel (0, 0) stands at (x0, y0), pitch in mm.
Topography reconstruct(std::span<const Grid<float>> stack, std::span<const double> z, double x0, double y0,
                       double pitch, const TopographyOptions& options);

// Statistics of measured against true over the points measured, after the same levelling (and, with a positive
// nesting index, the same L-filter) of both. Lengths in mm.
struct Deviation {
    double sq_measured = 0;
    double sq_true = 0;
    double rms = 0;            // of the difference, offset and tilt removed
    double correlation = 0;    // Pearson
    double measured_share = 0; // of all points
};

Deviation compare(const surface::HeightMap& measured, const surface::HeightMap& truth, double l_filter);

} // namespace vkfv::topography
