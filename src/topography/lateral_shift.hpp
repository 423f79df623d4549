// By how much a measurement lies beside the truth.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::topography {

// measured(x, y) = truth(x - shift.x, y - shift.y), offset and tilt aside. mm.
struct LateralShift {
    double x = 0;
    double y = 0;
    double correlation = 0; // Pearson, of both maps at that shift
};

// Least squares: the shift, offset and tilt that leave the least sum of squared differences over the points present in
// both, by Gauss and Newton's iteration in which the truth is resampled anew (surface/resample.hpp: exact to
// its interpolation, some hundredths of a pitch at wavelengths of four pitches, and far better where the truth is
// finer). It starts from the whole pitches, up to a quarter of either extent, at which both correlate best over their
// overlap; where several may be meant, the best of their minima counts. The truth may stand on any grid. A direction
// along which the truth does not vary but for a tilt has no shift: 0. NaN where nothing varies, maps do not overlap, no
// minimum is found in that range, or the correlation there is one that unrelated surfaces of the same waves may show.
// Works in 75 bytes a point besides the maps.
LateralShift lateral_shift(const surface::HeightMap& measured, const surface::HeightMap& truth);

// The truth as it would lie under the measurement: on its grid, moved by the shift.
surface::HeightMap shifted_onto(const surface::HeightMap& truth, const surface::HeightMap& measured,
                                const LateralShift& shift);

} // namespace vkfv::topography
