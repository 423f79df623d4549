// Computes a height map from a focus stack.
//
// The height of every pixel is found in these steps:
//
// - The images are averaged along z with Gaussian weights (smoothing_steps). Texture in focus stays in focus over
//   several steps, ray noise does not: averaging before the focus measure squares the noise helps most. A symmetric
//   average does not shift a symmetric focus curve. The width of the focus curves limits the average
//   (suitable_smoothing()).
//
// - A windowed focus measure of every averaged image (focus_measure.hpp) gives the focus curve along z.
//
// - The curve is averaged with the same weights, and its maximum is found to a fraction of a step
//   (peak_method.hpp).
//
// - The point is "not measured" where the maximum lies at either end of the scan, or where the curve is no better than
//   this stack's curves with the images in random order. The curve's unimodality and the order it shows (curve.glsl)
//   are compared. Their values by chance are found by shuffling the stack at some hundred places (focus_probes.hpp), so
//   the noise need not be known, and the limits hold for few images and many, for light of few rays and for texture
//   that a coarse scan jumps over. The pattern that makes the maximum must also persist from image to image, which that
//   of noise does not, however its strength changes along z (persistence.hpp). A point is not measured either if its
//   curve, averaged or not, has a second maximum almost as prominent as the first, or if its noise could hide a second
//   maximum where most curves of wider windows, which have less noise, show one. Further limits of quality can be set.
//
// - The height is that of the window's texture, wherever in the window this lies: it is carried to the window's middle
//   along the surface's slope (texture_place.hpp).
//
// Near the ends of the scan the averages contain only the existing images. Their larger noise is taken into account,
// and heights are corrected for curves as wide as those around the point (places_of_maxima.hpp); curves of another form
// than a Gaussian keep a part of the displacement towards the end. The two averages reach 6 smoothing_steps: plan the
// scan wider than the specimen by as much at either side, and at least by a depth of focus.
#pragma once

#include "core/mathematics/grid.hpp"
#include "surface/height_map.hpp"
#include "topography/focus_curves.hpp"
#include "topography/focus_measure.hpp"
#include "topography/focus_planes.hpp"
#include "topography/focus_probes.hpp"
#include "topography/host_focus_planes.hpp"
#include "topography/peak_method.hpp"
#include "topography/uncertainty/brightness_pull.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace vkfv::topography {

inline constexpr double most_smoothing_steps = 100; // 1202 images in memory

struct TopographyOptions {
    // Without a value FocusProbes::settle() chooses; the evaluator needs a measure.
    std::optional<FocusMeasure> focus_measure = where_little_is_averaged;
    int window_px = 7;                           // odd, at least 3
    WindowShape window_shape = WindowShape::box; // see FocusWindow
    PeakMethod peak = PeakMethod::gaussian;
    // Half width, in steps, of the range around the maximum for the fit, fit_residual and the number of peaks.
    int peak_range_steps = 3;
    // Standard deviation, in steps of the scan, of the Gaussian average along z; 0 switches it off. None:
    // FocusProbes::suitable_smoothing() chooses it; the evaluator needs a number.
    std::optional<double> smoothing_steps{};
    // Share of the points that would be measured with the images in random order; 1 switches the limit off. If a
    // twenty-fifth or more of all measured points would be measured by chance, and more than twice this rate, none is
    // measured. For few_images or fewer no more than most_unimodality_asked is demanded, since they are often in order
    // by chance; the evaluation reports the resulting rate.
    double false_peak_rate = 3e-3;
    // Prominence of the second maximum over the height of the largest above the curve's mean; 1 switches the limit off.
    double most_rival = 0.15;
    // Further limits for a point to count as measured; these values let all points pass.
    double least_contrast = 0;
    double most_fit_residual = 1;
    int most_peaks = 4;
    bool place_by_texture = true; // see texture_place.hpp
    bool repair_outliers = false; // see repair_outliers()

    // True if nothing is left to be chosen from the stack.
    bool settled() const { return focus_measure && smoothing_steps; }
};

// The status of a point.
enum class PointState : std::uint16_t {
    measured = 0,
    no_peak = 1,      // the largest value stands at an end of the scan, or the method finds no maximum
    by_chance = 2,    // no more unimodal than in random order, by false_peak_rate
    poor_fit = 3,     // fit residual above most_fit_residual
    many_peaks = 4,   // more than most_peaks, or a second maximum above most_rival
    repaired = 5,     // an outlier; its height is the median of its neighbours
    low_contrast = 6, // below least_contrast
    dark = 7,         // around it, brightness below a hundredth of the stack's mean
};

// Figures of a stack as a whole.
struct StackFigures {
    double smoothing_steps = 0;           // the average that was used
    double curve_width_steps = 0;         // standard deviation of its focus curves, FocusProbes::curve_width()
    ChanceLimit limit;                    // limit that a measured point exceeds
    Evidence whole;                       // mean of single images' curves at some places
    double rivalled_share = 0;            // share of wide windows' curves that have a second maximum above most_rival
    PersistenceLimit persistence;         // further limit that a measured point exceeds
    ChanceLimit limit_of_whole;           // limit that `whole` exceeds if anything is measured; none for few_images
    double image_noise = 0;               // standard deviation of a pixel over its brightness, at the mean brightness
    double hidden_relief = 0;             // mm, HiddenLevels::mean_deviation(): relief hidden within windows
    double brightness_pull = 0;           // mm, root mean square of Topography::brightness_pull where measured
    NoiseCorrelation noise_correlation{}; // correlation of neighbouring pixels' noise, FocusProbes::noise_correlation()

    bool rivalled() const { return rivalled_share > 0.5; }
};

struct Topography {
    surface::HeightMap height; // NaN: not measured
    // Height of the focus curve's maximum above its mean, in standard deviations of the curve's noise: dimensionless;
    // infinite for a stack without any noise.
    Grid<double> contrast;
    // Standard deviation of the height by the images' noise, mm; NaN: not measured.
    Grid<double> height_noise;
    // Standard uncertainty of the height from the disagreement of neighbouring windows, including noise
    // (height_uncertainty.hpp), from several levels within a window (hidden_levels.hpp) and from brightness that
    // changes with focus, mm; NaN: not measured.
    Grid<double> height_uncertainty;
    // The part of height_uncertainty by brightness that changes with focus, mm.
    BrightnessPull brightness_pull;
    // RMS distance of the curve from a Gaussian over the range around its maximum, in units of the maximum.
    Grid<double> fit_residual;
    // Number of local maxima, each the largest within the range around it, that stand at least half as high above the
    // curve's mean as the largest; 4 means "or more".
    Grid<std::uint16_t> peaks;
    Grid<PointState> state;
    // Every pixel from the two images around its height, linear between them; where nothing was measured, from those
    // around the largest value of the focus measure. In the images' unit; with as many channels as the images.
    Channels all_in_focus;
    StackFigures stack;
    FocusCurves curves; // at the pixels of the grid that was asked for
};

// Evaluates a stack whose images come one at a time, in one pass. With r = ceil(3 smoothing_steps), R =
// peak_range_steps and C channels it holds, however long the stack, for every pixel about 4 bytes for each of C (2r +
// 2R + 2) values of images and 4r + 4R + 4 of curves, and 270 + 50 C bytes besides: 630 MB for 1000 x 1000 grey pixels
// with smoothing_steps = 3, 1.9 GB with 20; and 256 MB at most for its probes.
class StackEvaluator {
  public:
    // `make_planes` makes the object that does the work: by the host's cores unless a device is given. Throws
    // InputError where an option is out of its range.
    explicit StackEvaluator(const TopographyOptions& options, FocusPlanesMaker make_planes = make_host_focus_planes,
                            CurveGrid curve_grid = {});

    // Adds the image at height z (mm). Images come in ascending z, equidistant to a hundredth of a step and all of one
    // size and number of channels, with finite values: InputError otherwise. reading: height at which a scale says that
    // the image was taken, mm, by which heights are then computed; for all images, or for none. Curves are followed as
    // if the steps were equal.
    void add(const Grid<float>& image, double z) { add(Channels{image}, z); }
    void add(Channels image, double z, std::optional<double> reading = {});

    // Evaluates all images added; pixel (0, 0) stands at (x0, y0), pitch in mm. At least three images: InputError
    // otherwise. It ends the evaluation: call it once.
    Topography finish(double x0, double y0, double pitch);

  private:
    void check(const Channels& image, double z) const;
    void begin(const Channels& first);
    // Number of images on either side that are compared with an image.
    int neighbours() const { return static_cast<int>(neighbour_weights_.size()) - 1; }
    void advance(bool all_taken);
    // The curves that are kept. records: of the curves' pixels, in their order.
    FocusCurves curves_of(const StackSummary& stack, const std::vector<focus::f64::CurveRecord>& records,
                          const std::function<double(double)>& height_at) const;
    StackFigures judge_stack() const;
    struct PointNoise {
        double single = 0;       // standard deviation of the measure of a single image
        double averaging = 1;    // factor on it that both averages leave
        double window_share = 1; // pixels of the window that lie in the image, over those of a whole window
    };
    PointState judge(const focus::f64::CurveRecord& curve, const focus::f64::SingleRecord& single,
                     const PointNoise& noise_here, const StackFigures& figures) const;

    TopographyOptions options_;
    FocusMeasure measure_;
    FocusWindow window_;
    std::vector<double> axial_weights_;
    // Weights of the neighbours that an image is compared with (persistence.hpp), by their distance.
    std::vector<double> neighbour_weights_;
    // Weights of these images' energies: the squares of neighbour_weights_. Where curves are averaged too, which widens
    // the mean again, neighbour_weights_ themselves are closer to the averaging.
    std::vector<double> energy_weights_;
    FocusPlanesMaker make_planes_;
    CurveGrid curve_grid_;
    std::optional<FocusProbes> probes_;            // from the first image on
    std::optional<FocusProbes> wide_;              // with a window several times as wide
    std::optional<BrightnessOfBlocks> brightness_; // from the first image on
    std::unique_ptr<FocusPlanes> planes_;          // from the first image on
    std::vector<std::uint32_t> curve_pixels_;      // indices of the curve grid's pixels, ascending
    int columns_ = 0;
    int rows_ = 0;
    std::size_t channels_ = 0;
    float scale_ = 1; // a power of two that brings the images near 1: squares of fluxes would leave a float's range
    std::vector<double> z_;
    std::vector<double> readings_;
    int measured_ = 0; // number of images
    int averaged_ = 0;
    int followed_ = 0;
};

// Replaces outliers by the median height of their neighbours, and marks them. An outlier is a measured point with at
// least 5 of its 8 neighbours measured whose distance from their median exceeds 6 robust standard deviations (1.4826
// times the median absolute distance of all such points): a share of 2e-9 of normal distances does.
void repair_outliers(Topography& topography);

// Evaluates a whole stack in memory: stack[k] is the image at z[k] (mm, ascending, equidistant).
Topography reconstruct(std::span<const Grid<float>> stack, std::span<const double> z, double x0, double y0,
                       double pitch, const TopographyOptions& options);

} // namespace vkfv::topography
