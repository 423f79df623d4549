// Probes: a few places of a stack whose images are kept. Their curves give the properties of the stack that the
// evaluation of all pixels needs: the width of its focus curves, the noise of its images, and the evidence of curves by
// chance.
#pragma once

#include "topography/axial_average.hpp"
#include "topography/chance.hpp"
#include "topography/focus_measure.hpp"
#include "topography/noise/noise_gain.hpp"
#include "topography/noise/texture_and_noise.hpp"
#include "topography/persistence.hpp"
#include "topography/saturation.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace vkfv::topography {

struct TopographyOptions; // topography.hpp

// With fewer images a quarter of the second differences along z is too few to be free of texture.
inline constexpr int least_images_for_correlation = 10;

// The widest average along z over the standard deviation of the focus curves: two thirds of a Gaussian's half width.
// Heights are best at 0.6 to 1, for stacks full of noise at 1; a wider average blurs more of a short scan.
inline constexpr double most_smoothing_of_width = 0.8;

// The least average along z that is made, in images: a smaller one averages little, but makes three images of curves as
// narrow as one unimodal.
inline constexpr double least_smoothing = 1;

// The noise of single images: variance = constant + slope * value, in the images' unit squared.
struct NoiseModel {
    double constant = 0;
    double slope = 0;
    double variance(double value) const { return constant + slope * (value > 0 ? value : 0); }
};

struct LevelsAtPlace;
class WindowResponses;

class FocusProbes {
  public:
    // Places probes on a regular grid, fewer if they would hold more than 128 MB.
    FocusProbes(int columns, int rows, FocusMeasure measure, const FocusWindow& window, int most_a_side = 16);

    void add(const Channels& image);

    // Standard deviation, in images, of the Gaussian that the focus curves resemble; 0: they have no form that outlasts
    // an image. It is found from their structure function, with the images closed to a ring of n: D(l) = mean of (F[k]
    // - F[k+l])^2 = 2 noise^2 + 2 S (1 - exp(-l^2 / (4 width^2)) - exp(-(n - l)^2 / (4 width^2))), whose first term
    // alone is noise's. At least 4 images; else 0.
    double curve_width() const;

    // The brightness of every image over the stack's mean, from all probes together.
    std::vector<double> brightness() const;

    Saturation saturation() const;

    // The noise of a channel, by least squares over all probes from the smallest quarter of each probe's second
    // differences along z: texture that comes into focus makes others larger. Images are scaled to the mean brightness,
    // so that flickering light is no noise, and saturated values are left out.
    NoiseModel noise() const;

    // The noise correlation of pixels, from the smallest of the same second differences; every probe counts alike, all
    // channels together. Values below four of their standard deviations are 0, so independent noise stays independent;
    // it is independent too for fewer than least_images_for_correlation images and for images without noise.
    NoiseCorrelation noise_correlation() const;

    // The propagation of the images' noise into curves that are averaged by these weights. model, correlation: noise()
    // and noise_correlation(). Empty where the probes are few, hardly wider than the image, or show no texture or no
    // noise.
    std::optional<TextureAndNoise> texture_and_noise(const std::vector<double>& axial_weights, const NoiseModel& model,
                                                     const NoiseCorrelation& correlation) const;

    // Several levels of height at the probes whose patch lies in the image and whose texture is above noise
    // (hidden_levels.hpp). axial_weights: of both averages. Empty for fewer than least_images_for_correlation images,
    // where the curves have no form, and for fewer than nine such probes.
    std::vector<LevelsAtPlace> levels(const std::vector<double>& axial_weights) const;

    // The evidence of curves with the images in random order, zero where the largest value stands at an end.
    // axial_weights: of both averages (axial_average.hpp). The number of orders suffices for the limit that a share of
    // `rate` exceeds; it is larger if an order is cheap.
    std::vector<Evidence> by_chance(const std::vector<double>& axial_weights, double rate) const;

    // The part of their energy that images of noise alone share by chance (persistence.hpp). The images are made of the
    // stack's noise, which is the second differences along z of its quiet images: each image takes the patch of another
    // probe, scaled to one strength. neighbour_weights: weights of an image's neighbours by their distance;
    // curves_averaged: the focus curves are averaged by the same weights. The result is empty if there are few probes
    // or no noise.
    IndependentImages independent_images(const std::vector<double>& neighbour_weights, bool curves_averaged) const;

    // How far strong texture persists from image to image (persistence.hpp). Texture is strong where the focus measure
    // rises to eight times its quiet value and that of rounding to grey values. The result is empty if hardly any probe
    // has strong texture. The share is small if the images move, or if texture is in focus in one image alone. A
    // pattern that is not found in the neighbouring image at any place nearby is noise and does not count, unless such
    // places show a surface that is not level.
    std::optional<StrongTexture> persistence_of_strong_texture(const std::vector<double>& neighbour_weights,
                                                               bool curves_averaged) const;

    // The energy (the square of the focus measure of an image) below which what the probes show is no evidence of
    // texture: twice the largest at which a fifth or more of the patterns of neighbouring images do not agree, and at
    // least four times the least energy of places that show nothing at all in other images. Compression leaves such
    // places, where the blocks of a blank part are flat or have one of a few patterns; chance alone then makes
    // neighbouring images alike. 0: all patterns agree.
    double least_energy() const;

    // The share of the probes whose curves have a second maximum with at least this prominence over the first's height
    // above the mean, and more than noise makes. Noise is found from second differences of single images' curves, which
    // narrow peaks make larger: fewer are found then. axial_weights: of both averages.
    double share_with_rival(const std::vector<double>& axial_weights, double most_rival) const;

    // Curves of single images at every seventh probe, by which the stack as a whole is judged (chance.hpp).
    std::vector<std::vector<double>> some_curves() const;

    // The distance from the nearer end of the scan, in images, below which this share of the curves' maxima lies.
    // Curves count by the square of their neighbouring values' correlation; those whose maximum is at an end do not
    // count.
    double distance_from_the_ends(double share_nearer) const;

    // The standard deviation of the average along z, in images, that suits these curves: in proportion to their width,
    // or less where it would bring one maximum in twenty or more to an end of the scan. 0 for few_images or fewer.
    double suitable_smoothing() const;

    // Noise's share of the focus measure's energy at the maxima of the curves, averaged over the probes, with the
    // average along z that suits them. Empty where the probes do not show it.
    std::optional<double> noise_share() const;

    // Changes to another measure, as if it had been given at first.
    void measure_by(FocusMeasure measure);

    // Chooses the options that are open. The probes use the options' measure, or where_noise_is_low, which is replaced
    // by where_noise_counts unless noise has next to nothing of its energy, and by where_little_is_averaged if there is
    // no average along z.
    void settle(TopographyOptions& options);

  private:
    struct Probe {
        int column = 0; // column of the image at which its patch begins
        int row = 0;
        int columns = 0; // size of the patch
        int rows = 0;
        int middle_column = 0; // place of the patch's middle in the patch
        int middle_row = 0;
        std::vector<float> values;   // image by image, channel by channel, row by row
        std::vector<double> singles; // focus measure of each image

        std::size_t pixels() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
    };

    // Adds the focus measure of the image whose patches were added last to each probe.
    void follow_singles();
    double single_of(const Probe& probe, std::size_t image) const;

    // Two neighbouring images at a probe.
    struct PlaceOfImages {
        const Probe* probe;
        std::size_t image, neighbour;
    };
    // The patterns of all images less the mean of those with the least focus, a third of all.
    std::vector<std::vector<double>> patterns(const Probe& probe) const;
    // True if the patterns of images are found in their neighbours too, at the same place or wherever they have moved:
    // if one of these correlations exceeds that with other places' neighbours by more than chance. Texture that is
    // sharp in one image alone is seen at its own place, since its blurred neighbour is like many places by some shift.
    // True also if places are few.
    bool reappears(const std::vector<PlaceOfImages>& places) const;
    // True if the images of the largest focus measure follow each other along rows or columns of places whose patches
    // do not overlap: texture on a surface that is not level is sharp in an image of its own, whereas all places see
    // the same noise.
    static bool lie_on_a_surface(const std::vector<PlaceOfImages>& places);

    // Second differences along z of a channel, evaluated.
    struct Differences {
        std::vector<double> variances{}; // a single image's noise, by the second difference at image 1, 2, ...
        double level = 0;                // mean brightness of all
        double variance = 0;             // mean of the smallest quarter of the variances; sparse: of all
        bool sparse = false;             // most of the values are 0
    };
    // Scale of the values of which second differences are taken: gains bring each image to the stack's mean brightness;
    // values from `saturated` on are left out.
    struct Scale {
        std::vector<double> gains;
        float saturated;
    };
    Scale scale() const;
    // The second difference along z at value k of the probe's patch (all channels, one after the other); it is empty if
    // one of the three values is saturated.
    std::optional<double> second_difference(const Probe& probe, int image, std::size_t k, const Scale& scale) const;
    Differences differences(const Probe& probe, std::size_t channel, const Scale& scale) const;
    std::vector<Differences> all_differences(const Scale& scale) const; // channels of the first probe, then of the next

    // A patch of all channels whose differences from 1 have the focus measure `contrast`; empty if there are no
    // differences.
    Channels noise_patch(const Probe& probe, int image, double contrast, const Scale& scale) const;

    // Products of second differences that are noise: the images used, and sums of products of pixels (dx, dy) apart, 0
    // <= dy <= reach, -reach <= dx <= reach.
    struct Products {
        std::vector<int> images{};
        Grid<double> sums{};
    };
    Products products_of(const Probe& probe, std::size_t channel, const Scale& scale) const;

    // Responses to patches of noise, divided by the model's standard deviation: the second differences of quiet images
    // at these probes, or random numbers of their variance where the noise is independent.
    std::vector<std::vector<double>> noise_responses(const WindowResponses& responses,
                                                     const std::vector<std::size_t>& places, const NoiseModel& model,
                                                     const NoiseCorrelation& correlation) const;

    // The variance of quiet images at these probes over the model's, which takes the smallest of some; 1 for few
    // images.
    double variance_over(const NoiseModel& model, const std::vector<std::size_t>& places) const;

    // The shares of every mean: of the images, then of the curve's values.
    struct Means {
        std::vector<std::vector<Share>> images, curve;
    };
    static Means means_of(const std::vector<double>& axial_weights, int count);

    // The focus measure of rounding: of values about this brightness, rounded to the grey values that the probes have.
    double measure_of_rounding(double brightness) const;

    // A probe's patch of all channels in the weighted mean of images, over its mean brightness; 0 where the brightness
    // is 0.
    std::vector<double> mean_patch(const Probe& probe, const std::vector<Share>& shares) const;
    // The curve of a probe from weighted means of images in this order.
    std::vector<double> curve(const Probe& probe, const std::vector<int>& order, const Means& means) const;
    // The curve of a probe's single images, averaged along z as curves are.
    static std::vector<double> averaged_singles(const Probe& probe, const Means& means);
    // The curve of each probe after both averages.
    std::vector<std::vector<double>> curves_in_order(const Means& means) const;

    FocusMeasure measure_;
    FocusWindow window_;
    std::size_t pixels_; // pixels of an image
    std::vector<Probe> probes_;
    int channels_ = 0;
    int images_ = 0;
};

// The standard deviation of the average along z, in images, for focus curves of this standard deviation in images:
// most_smoothing_of_width times it, at most a tenth of the scan and at most most_smoothing_steps; 0 if this is below
// least_smoothing.
double suitable_smoothing(double curve_width, int images);

} // namespace vkfv::topography
