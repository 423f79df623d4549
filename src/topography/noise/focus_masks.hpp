// The masks of the focus measures as numbers, through which noise beside texture passes linearly.
#pragma once

#include "topography/focus_measure.hpp"

#include <array>
#include <vector>

namespace vkfv::topography {

inline constexpr int mask_reach = 2; // reach of the masks, pixels

// A separable mask: the weight at (i, j), from -mask_reach to mask_reach, is x[i] y[j].
struct Mask {
    std::array<double, 5> x;
    std::array<double, 5> y;
};

// The masks of a measure. The measure responds with the energy, the sum over its masks of (mask * image)^2; gradient
// and curvature with its root, the modified Laplacian with the sum of the magnitudes, the standard deviation (one mask,
// of the pixel alone) after the window's mean is subtracted.
std::vector<Mask> masks_of(FocusMeasure measure);

} // namespace vkfv::topography
