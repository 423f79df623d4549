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

// Mean over the same windows.
Grid<float> window_mean(const Grid<float>& image, int window_px);

// Pixels in the window around a pixel, less than window_px^2 near the border.
int window_pixels(int columns, int rows, int column, int row, int window_px);

// Standard deviation of the measure over a window of n pixels, for independent image noise of relative
// standard deviation 1 in every pixel; noise passes linearly for small values. Standard deviation: at most 1
// / sqrt(n) (that is its value where texture exceeds noise; 1 / sqrt(2 n) without texture). Modified
// Laplacian: sqrt(12 / n): the second differences along x and y each have the variance 6, and their absolute
// values, with signs from texture, do not correlate between pixels on average; without texture the
// covariances (2/pi)(sqrt(1 - r^2) + r asin r - 1) of absolute normal variables add up to 12.02 / n.
double noise_gain(FocusMeasure measure, int window_pixels);

} // namespace vkfv::topography
