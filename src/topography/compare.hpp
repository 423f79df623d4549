// Compares measured with true heights.
#pragma once

#include "surface/band.hpp"

#include <limits>

namespace vkfv::topography {

using surface::Band; // form and filters that both surfaces are compared after

// Statistics of measured against true heights over the points present in both, after the same form removal and filters
// of both. Lengths in mm; NaN where no point is present.
struct Deviation {
    double sq_measured = 0;
    double sq_true = 0;
    double rms = 0;            // RMS difference, offset and tilt removed; with the form "none" about zero, unchanged
    double correlation = 0;    // Pearson's coefficient; 0 where either is flat
    double measured_share = 0; // points present in both, as a share of all points
    // The least-squares line of measured on true heights, measured = offset + slope * true: the instrument's
    // amplification of heights, and its zero. After levelling the offset is 0. NaN where the true heights are flat.
    double slope = std::numeric_limits<double>::quiet_NaN();
    double offset = std::numeric_limits<double>::quiet_NaN();
};

// The ratio measured / truth; NaN where the truth is 0, as the Sq of a flat is.
double ratio_to_truth(double measured, double truth);

// Two maps prepared for comparison: points not measured in one are not measured in both; the form of each is removed
// (by default its least-squares plane), then the filters are applied. With the form "truth" the truth is unchanged, and
// the measured heights lose the least-squares plane of their deviation from it: no step or slope of the truth is lost.
struct LevelledPair {
    surface::HeightMap measured;
    surface::HeightMap truth;
    bool form_removed = true; // false with the form "none"
};

// Prepares both maps, which stand on the same grid (surface/resample.hpp resamples them): std::invalid_argument
// otherwise, here and below.
LevelledPair levelled_pair(surface::HeightMap measured, surface::HeightMap truth, const Band& band = {});

// The statistics of a prepared pair. deviation: of deviation_map().
Deviation compare(const LevelledPair& treated, const surface::HeightMap& deviation);
Deviation compare(const LevelledPair& treated);
Deviation compare(const surface::HeightMap& measured, const surface::HeightMap& truth, const Band& band = {});

// Measured minus true height after the preparation of compare(); its root mean square is Deviation::rms.
surface::HeightMap deviation_map(const LevelledPair& treated);
surface::HeightMap deviation_map(const surface::HeightMap& measured, const surface::HeightMap& truth,
                                 const Band& band = {});

// Measured and true heights in one band, with their difference. It is computed once, since figures, maps and files need
// all of it.
struct ComparedPair {
    LevelledPair pair;
    surface::HeightMap difference; // deviation_map()
    Deviation deviation;
};
ComparedPair compared_pair(surface::HeightMap measured, surface::HeightMap truth, const Band& band = {});

// The share of the deviation's finite points that are further from zero than coverage_factor times their standard
// uncertainty (mm, on the same grid: std::invalid_argument otherwise; a point without one counts as beyond); NaN if
// there are no such points.
double share_beyond(const surface::HeightMap& deviation, const Grid<double>& uncertainty, double coverage_factor);

} // namespace vkfv::topography
