// Measured against true heights.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::topography {

// Which waves of both surfaces are compared: nesting indices of the S-filter and L-filter, mm; 0: none.
struct Band {
    double s_filter = 0; // shorter waves are removed
    double l_filter = 0; // longer waves are removed
    bool spline = false; // by surface/spline_filter.hpp, not by the Gaussian of ISO 16610-61

    bool limited() const { return s_filter > 0 || l_filter > 0; }
};

// Statistics of measured against true over the points present in both, after the same levelling and filters of both.
// Lengths in mm; NaN where no point is present.
struct Deviation {
    double sq_measured = 0;
    double sq_true = 0;
    double rms = 0;            // of the difference, offset and tilt removed
    double correlation = 0;    // Pearson; 0 where either is flat
    double measured_share = 0; // points present in both, of all points
};

// The treatment itself: what is not measured in one is so in both; the least-squares plane of each is removed.
struct LevelledPair {
    surface::HeightMap measured;
    surface::HeightMap truth;
};

// Both maps stand on the same grid (surface/resample.hpp brings them there): std::invalid_argument otherwise, here and
// below.
LevelledPair levelled_pair(surface::HeightMap measured, surface::HeightMap truth, const Band& band = {});

Deviation compare(const surface::HeightMap& measured, const surface::HeightMap& truth, const Band& band = {});

// Measured less true after the treatment of compare(); its root mean square is Deviation::rms.
surface::HeightMap deviation_map(const surface::HeightMap& measured, const surface::HeightMap& truth, const Band& band = {});

} // namespace vkfv::topography
