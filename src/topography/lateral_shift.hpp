// The lateral displacement of a measurement from the truth.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::topography {

// The shift in measured(x, y) = truth(x - shift.x, y - shift.y), without offset and tilt; mm.
struct LateralShift {
    double x = 0;
    double y = 0;
    double correlation = 0; // Pearson's coefficient of both maps at that shift
};

// The least-squares shift: the shift, offset and tilt with the least sum of squared differences over the points present
// in both, by Gauss and Newton's iteration, in which the truth is resampled anew (surface/resample.hpp: exact to its
// interpolation, some hundredths of a pitch at wavelengths of four pitches, and far better where the truth is finer).
// It starts from the whole pitches, up to a quarter of either extent, at which both correlate best over their overlap;
// of several starting points the best minimum counts. The truth may stand on any grid. A direction along which the
// truth does not vary except for a tilt has no shift: 0. NaN where nothing varies, maps do not overlap, no minimum is
// found in that range, or the correlation there could be that of unrelated surfaces with the same waves. It needs 75
// bytes a point besides the maps.
LateralShift lateral_shift(const surface::HeightMap& measured, const surface::HeightMap& truth);

// The truth as it lies under the measurement: on the measurement's grid, moved by the shift.
surface::HeightMap shifted_onto(const surface::HeightMap& truth, const surface::HeightMap& measured,
                                const LateralShift& shift);

} // namespace vkfv::topography
