// Focus measures: the strength of an image's lateral texture around each pixel. Their formulas stand in shaders/focus/,
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

// The mean of the channels.
Grid<float> grey(const Channels& channels);

// Values are the constants FOCUS_*.
enum class FocusMeasure {
    standard_deviation = focus::f64::FOCUS_STANDARD_DEVIATION, // local standard deviation
    tenengrad = focus::f64::FOCUS_TENENGRAD,                   // root mean square of Sobel's gradient
    modified_laplacian = focus::f64::FOCUS_MODIFIED_LAPLACIAN, // mean of the modified Laplacian
    brenner = focus::f64::FOCUS_BRENNER,                       // root mean square of differences of pixels two apart
    wavelet = focus::f64::FOCUS_WAVELET,                       // root mean square of the detail bands
    // mean magnitude of Sobel's gradient with second differences
    gradient_and_curvature = focus::f64::FOCUS_GRADIENT_AND_CURVATURE,
};

// The names of the measures in the order of FocusMeasure: "standard-deviation", "tenengrad", "modified-laplacian",
// "brenner", "wavelet", "gradient-and-curvature".
const std::vector<std::string>& focus_measure_names();
const std::string& name_of(FocusMeasure measure);
// The measure with this name; InputError for any other name.
FocusMeasure focus_measure_from_name(std::string_view name);

// Measures with the least scatter of heights, or nearly so (docs/topography.md): where a camera's noise dominates;
// where the errors are dominated by the place of texture; and in light that vkfv has traced without a camera.
inline constexpr FocusMeasure where_noise_counts = FocusMeasure::gradient_and_curvature;
inline constexpr FocusMeasure where_noise_is_low = FocusMeasure::modified_laplacian;
inline constexpr FocusMeasure where_texture_is_traced = FocusMeasure::wavelet;
// The measure that measures the most points where there is no average along z, since images are few or curves narrow.
inline constexpr FocusMeasure where_little_is_averaged = FocusMeasure::wavelet;

enum class WindowShape { box, gaussian };

// The names in the order of WindowShape: "box", "gaussian".
const std::vector<std::string>& window_shape_names();
const std::string& name_of(WindowShape shape);
// The shape with this name; InputError for any other name.
WindowShape window_shape_from_name(std::string_view name);

// The window over which a focus measure is averaged around every pixel, cut off at the border of the image.
class FocusWindow {
  public:
    // width_px: odd. gaussian: the standard deviation is width_px / 5, so that the weight falls to 4 % at the window's
    // edge; box: all weights are 1.
    FocusWindow(int width_px, WindowShape shape);

    int radius() const { return static_cast<int>(weights_.size()) - 1; }
    // Weights of a row or column at this distance from the middle, 0..radius; a pixel's weight is the product of both.
    const std::vector<double>& weights() const { return weights_; }
    // The number of pixels of equal weight that average independent noise as well: (sum w)^2 / sum w^2.
    double pixels(int columns, int rows, int column, int row) const;

  private:
    std::vector<double> weights_;
};

// The measure over the window around every pixel, over all channels (response.glsl), divided by the brightness there
// and so dimensionless: a slowly varying illumination cancels. Where the local mean is not positive the measure is 0.
// The arithmetic is double; rows are shared among threads, and the result does not depend on how.
Grid<float> focus_measure(const Channels& image, FocusMeasure measure, const FocusWindow& window);

// The measure at one pixel, without threads.
double focus_at(const Channels& image, FocusMeasure measure, const FocusWindow& window, int column, int row);

// The response of the measure at each pixel, summed over channels, which the windows average. The standard deviation
// has no response: the squared distance from the mean of the window around the pixel stands for it.
Grid<double> focus_responses(const Channels& image, FocusMeasure measure, const FocusWindow& window);

// The weighted mean over the windows around every pixel.
Grid<float> window_mean(const Grid<float>& image, const FocusWindow& window);

} // namespace vkfv::topography
