// Focus measures: how much lateral texture an image has around each pixel.
#pragma once

#include "core/grid.hpp"

#include <string_view>

namespace vkfv::topography {

enum class FocusMeasure {
    standard_deviation, // local standard deviation over local mean
    modified_laplacian, // local mean of |2I - I(x-1) - I(x+1)| + |2I - I(y-1) - I(y+1)| over local mean
                        // (Nayar and Nakagawa, "Shape from focus", 1994); blind to linear gradients of
                        // brightness
};

// "standard-deviation" or "modified-laplacian"; InputError otherwise.
FocusMeasure focus_measure_from_name(std::string_view name);

// The measure over window_px x window_px pixels (odd) around every pixel; dimensionless, so that a slowly
// varying illumination cancels. At the border the window is cut off (at least (window_px + 1) / 2 pixels
// remain either way), and the Laplacian mirrors the image at its outermost pixels. Where the local mean is
// not positive the measure is 0. Rows are shared among threads; the result does not depend on how.
Grid<float> focus_measure(const Grid<float>& image, FocusMeasure measure, int window_px);

// Relative standard deviation of the measure, whole window, on a featureless image with independent normal
// noise. Standard deviation: 1 / sqrt(2 (n - 1)) over n = window_px^2 pixels (chi distribution, leading
// order). Modified Laplacian: sqrt(c / n), c the summed covariance of |X| and |Y| over all pairs of second
// differences that share pixels: for normal variables of correlation r it is (2/pi)(sqrt(1 - r^2) + r asin r
// - 1).
double noise_deviation(FocusMeasure measure, int window_px);

} // namespace vkfv::topography
