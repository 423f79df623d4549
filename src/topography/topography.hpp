// From a focus stack to a height map.
//
// How a height is found, for every pixel:
//
// - The images are averaged along z with Gaussian weights (smoothing_steps). Texture in focus stays in focus
//   over several steps, ray noise does not: averaging before the focus measure squares the noise helps most.
//   A symmetric average does not shift a symmetric focus curve.
//
// - A windowed focus measure of every averaged image (focus_measure.hpp) gives the focus curve along z.
//
// - The curve is averaged with the same weights, and the three points around its maximum give the height by a
//   Gaussian fit (peak.hpp).
//
// - The point is "not measured" where the maximum lies at either end of the scan, or stands no further above
//   the curve's mean than image noise alone would bring it at `false_peak_rate`. The noise is taken from the
//   stack itself: from second differences along z, in which texture that changes slowly cancels.
//
// Near the ends of the scan the averages hold only the images there are, which draws heights within about two
// smoothing_steps of an end inwards: plan the scan a depth of focus wider than the specimen at either side.
#pragma once

#include "core/grid.hpp"
#include "surface/height_map.hpp"
#include "topography/axial_average.hpp"
#include "topography/focus_measure.hpp"
#include "topography/peak.hpp"

#include <deque>
#include <span>
#include <string>
#include <vector>

namespace vkfv::topography {

struct TopographyOptions {
    std::string focus_measure = "standard-deviation"; // or "modified-laplacian"
    int window_px = 7;                                // odd, at least 3
    std::string peak = "gaussian";                    // the only one
    // Standard deviation, in steps of the scan, of the Gaussian average along z; 0 switches it off. Best at
    // about half the half width of the focus curve: 3 for steps of an eighth of it, less for coarser steps.
    double smoothing_steps = 3;
    // Probability that a pixel gets a height from noise alone, its texture not changing along z. An upper
    // bound for normal sums: with windows below 7 pixels and no average along z the skew of the measure may
    // double it.
    double false_peak_rate = 1e-3;
};

struct Topography {
    surface::HeightMap height; // NaN: not measured
    // Height of the focus curve's maximum over its mean in standard deviations of the curve's noise:
    // dimensionless; infinite on a stack without any noise.
    Grid<double> quality;
};

// Evaluates a stack whose images come one at a time: beside a few numbers a pixel it holds
// 2 (6 smoothing_steps + 2) images, however long the stack.
class StackEvaluator {
  public:
    // Throws InputError where an option is out of its range.
    explicit StackEvaluator(const TopographyOptions& options);

    // The image at height z (mm). Images come in ascending z, equidistant to a hundredth of a step and all of
    // one size, with finite values: InputError otherwise.
    void add(const Grid<float>& image, double z);

    // The heights of all images added; pixel (0, 0) stands at (x0, y0), pitch in mm. At least three images:
    // InputError otherwise. Ends the evaluation: call it once.
    Topography finish(double x0, double y0, double pitch);

  private:
    void measure(const Grid<float>& averaged_image);
    void observe_noise(const Grid<float>& image);
    Grid<float> relative_noise() const;

    FocusMeasure focus_measure_;
    int window_px_;
    double false_peak_rate_;
    AxialAverage images_;
    AxialAverage curves_;
    int columns_ = 0;
    int rows_ = 0;
    std::vector<double> z_;
    std::deque<Grid<float>> latest_;  // the last two images
    Grid<float> brightness_;          // sum of all images
    Grid<float> squared_differences_; // sum of (I[k-1] - 2 I[k] + I[k+1])^2
    PeakTracker peaks_;
};

// The smallest quality that counts as a peak among so many images. The largest of n normal values exceeds t
// standard deviations with probability below n exp(-t^2 / 2) / 2, the union bound with Chernoff's tail;
// solved for t.
double quality_threshold(int images, double false_peak_rate);

// A whole stack in memory: stack[k] is the image at z[k] (mm, ascending, equidistant).
Topography reconstruct(std::span<const Grid<float>> stack, std::span<const double> z, double x0, double y0,
                       double pitch, const TopographyOptions& options);

} // namespace vkfv::topography
