// The comparison of one measurement, or of repeated ones, with the truth.
#pragma once

#include "surface/areal_parameters.hpp"
#include "topography/compare.hpp"
#include "topography/height_transfer.hpp"
#include "topography/lateral_shift.hpp"
#include "topography/repeatability.hpp"
#include "topography/slope_deviation.hpp"

#include <optional>
#include <span>
#include <vector>

namespace vkfv::topography {

// The comparison of one measurement, over the points present in it and in the truth, both treated alike
// (levelled_pair()).
struct MeasurementComparison {
    LateralShift shift; // as found, whether removed or not
    Deviation deviation;
    surface::ArealParameters measured;
    surface::ArealParameters truth;
};

struct Comparison {
    std::vector<MeasurementComparison> measurements;
    LateralShift removed_shift;               // mean shift of the measurements, if it was to be removed; otherwise 0
    surface::HeightMap truth;                 // at the measurements' points, on their grid, untreated
    surface::HeightMap deviation;             // for repeated measurements their mean (repeatability.hpp)
    std::optional<SystematicAndRandom> parts; // for two measurements or more
    // The following are of the deviation after levelling alone, whatever the band: a filter or form would hide their
    // effects.
    std::vector<TransferBand> transfer; // from `truth` to truth + deviation
    std::vector<SlopeBin> slopes;       // in bins of two degrees
};

// Compares measurements on one grid (std::invalid_argument otherwise) with a truth on any grid. `align` moves the truth
// by the mean of the shifts found; a measurement without one does not count there. The shift is that of the levelled
// surfaces, whatever the band.
Comparison compare_with_truth(std::span<const surface::HeightMap> measurements, const surface::HeightMap& truth,
                              bool align, const Band& band = {});

} // namespace vkfv::topography
