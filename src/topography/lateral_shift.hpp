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
// finer). It starts from the highest cross-correlation among whole pitches, up to a quarter of either extent, by
// Fourier transform with gaps at the mean height. The truth may stand on any grid. A direction along which the truth
// does not vary has no shift: 0. NaN where nothing varies, maps do not overlap, or no minimum is found near that start.
LateralShift lateral_shift(const surface::HeightMap& measured, const surface::HeightMap& truth);

// The truth as it would lie under the measurement: on its grid, moved by the shift.
surface::HeightMap shifted_onto(const surface::HeightMap& truth, const surface::HeightMap& measured,
                                const LateralShift& shift);

} // namespace vkfv::topography
