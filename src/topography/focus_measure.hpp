// Focus measures: how much lateral texture an image has around each pixel. What they compute stands in shaders/focus/,
// a file each, shared with the device.
#pragma once

#include "core/mathematics/grid.hpp"
#include "focus/focus.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace vkfv::topography {

// The channels of one image, all of one size: one of grey, three of colour.
using Channels = std::vector<Grid<float>>;

// Their mean.
Grid<float> grey(const Channels& channels);

// In the order of the constants FOCUS_*.
enum class FocusMeasure {
    standard_deviation = focus::f64::FOCUS_STANDARD_DEVIATION, // local standard deviation
    tenengrad = focus::f64::FOCUS_TENENGRAD,                   // root mean square of Sobel's gradient
    modified_laplacian = focus::f64::FOCUS_MODIFIED_LAPLACIAN, // mean of the modified Laplacian
    brenner = focus::f64::FOCUS_BRENNER,                       // root mean square of differences of pixels two apart
    wavelet = focus::f64::FOCUS_WAVELET,                       // root mean square of the detail bands
    // mean magnitude of Sobel's gradient with second differences
    gradient_and_curvature = focus::f64::FOCUS_GRADIENT_AND_CURVATURE,
};

// "standard-deviation", "tenengrad", "modified-laplacian", "brenner", "wavelet", "gradient-and-curvature", in the
// order of FocusMeasure.
const std::vector<std::string>& focus_measure_names();
const std::string& name_of(FocusMeasure measure);
// InputError for any other name.
FocusMeasure focus_measure_from_name(std::string_view name);

// What scatters least, or hardly more than the least (docs/topography.md): where a camera's noise counts; where the
// place of texture alone makes the errors of heights; and in light that vkfv has traced without a camera.
inline constexpr FocusMeasure where_noise_counts = FocusMeasure::gradient_and_curvature;
inline constexpr FocusMeasure where_noise_is_low = FocusMeasure::modified_laplacian;
inline constexpr FocusMeasure where_texture_is_traced = FocusMeasure::wavelet;
// What measures the most points where there is no average along z, since images are few or curves narrow.
inline constexpr FocusMeasure where_little_is_averaged = FocusMeasure::wavelet;

enum class WindowShape { box, gaussian };

// "box", "gaussian".
const std::vector<std::string>& window_shape_names();
const std::string& name_of(WindowShape shape);
// InputError for any other name.
WindowShape window_shape_from_name(std::string_view name);

// What a focus measure is gathered over, around every pixel; cut off at the border of the image.
class FocusWindow {
  public:
    // width_px: odd. A Gaussian of standard deviation width_px / 5, so that its weight falls to 4 % at the window's
    // edge; box: all weights are 1.
    FocusWindow(int width_px, WindowShape shape);

    int radius() const { return static_cast<int>(weights_.size()) - 1; }
    // Of a row or column at this distance from the middle, 0..radius; a pixel's weight is the product of both.
    const std::vector<double>& weights() const { return weights_; }
    // Pixels of equal weight that average independent noise as well: (sum w)^2 / sum w^2.
    double pixels(int columns, int rows, int column, int row) const;

  private:
    std::vector<double> weights_;
};

// The measure over the window around every pixel, over all channels (response.glsl), divided by the brightness there
// and so dimensionless: a slowly varying illumination cancels. Where the local mean is not positive the measure is 0.
// In double; rows are shared among threads, and the result does not depend on how.
Grid<float> focus_measure(const Channels& image, FocusMeasure measure, const FocusWindow& window);

// The same at one pixel, without threads.
double focus_at(const Channels& image, FocusMeasure measure, const FocusWindow& window, int column, int row);

// What the windows gather of each pixel: the response of the measure, summed over channels. The standard deviation has
// none of its own: the squared distance from the mean of the window around the pixel stands for it.
Grid<double> focus_responses(const Channels& image, FocusMeasure measure, const FocusWindow& window);

// Weighted mean over the same windows.
Grid<float> window_mean(const Grid<float>& image, const FocusWindow& window);

} // namespace vkfv::topography
