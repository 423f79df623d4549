// The masks of the focus measures as numbers: what passes through them linearly, as noise beside texture does.
#pragma once

#include "topography/focus_measure.hpp"

#include <array>
#include <vector>

namespace vkfv::topography {

inline constexpr int mask_reach = 2; // pixels

// The weight at (i, j), from -mask_reach to mask_reach, is x[i] y[j].
struct Mask {
    std::array<double, 5> x;
    std::array<double, 5> y;
};

// The measure responds with the energy sum over these of (mask * image)^2; gradient and curvature with the root of
// that, the modified Laplacian with the sum of the magnitudes, the standard deviation (one mask, of the pixel alone)
// after the window's mean is taken off.
std::vector<Mask> masks_of(FocusMeasure measure);

} // namespace vkfv::topography
