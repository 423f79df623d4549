// Persistence distinguishes texture from noise whose strength changes along z, as it does with a lamp's light or a
// camera's gain. Curves of such noise can be as smooth and as unimodal as those of texture, and images in random order
// do not show it, since they lose the noise's order too. But noise has another pattern in every image, and texture that
// comes into focus has the same pattern in several.
//
// An image and its neighbours have weights a_k that add up to 1; their squares add up to f. The joint energy J is the
// square of the focus measure of the weighted mean of these images. The alone energy E is the mean square of the
// images' own focus measures. If an energy S persists and an energy N changes from image to image, E = S + N and J = S
// + f N. So
//
//   S = (J - m f E) / (1 - m f),   N = E - S,
//
// where m is the part of E that independent images of the stack leave in J, over f: near 1, and not quite 1 since
// measures of absolute values are no energies.
//
// Chance makes images alike by their products: the standard deviation of J - f E is in proportion to
//
//   Q = 2 sqrt(sum over pairs of images of (a_i a_k F_i F_k)^2),
//
// F being the images' own focus measures. Q is f E where these are equal, and less where one image dominates:
// neighbours that are weaker, and alike nonetheless, are evidence too. So texture is found that is sharp in hardly more
// than one image.
#pragma once

#include "focus/focus.hpp"
#include "topography/axial_average.hpp"

#include <optional>
#include <vector>

namespace vkfv::topography {

// The distribution of J / (f E) over stacks of images with independent noise.
struct IndependentImages {
    double mean = 1;      // m
    double deviation = 0; // standard deviation; 0: it is unknown, and no limit is set
    double largest = 0;   // largest value found: few grey values have rarer and larger ones than the deviation suggests
};

// The median over places whose texture is strong.
struct StrongTexture {
    double share;       // of the energy E that persists, S / E
    double correlation; // the weighted mean correlation of the patterns of neighbouring images, however strong each is
};

class PersistenceLimit {
  public:
    // No limit is set.
    PersistenceLimit() = default;
    // The limit that curves of noise alone exceed with the probability `rate`, wherever in the scan they have their
    // maximum. neighbour_weights: of an image's neighbours, by their distance. curves_averaged: the curves are averaged
    // by the same weights, so that neighbouring images count as equally strong. strong_texture: the correlation of
    // images of the stack's strong texture, if it is known. least_energy: of E, where J does not tell texture from
    // noise (tells()).
    PersistenceLimit(const IndependentImages& independent, const std::vector<double>& neighbour_weights,
                     bool curves_averaged, int images, double rate, std::optional<double> strong_texture = {},
                     double least_energy = 0);

    // False if nothing is known of the noise, or if its images are so often alike by chance that texture does not
    // exceed the limit. In the blank parts of compressed images only a few patterns are left, and in most images none.
    bool tells() const;

    // True if the energy that makes the curve's maximum persists: J exceeds the limit of noise alone, or half of E
    // persists; and S rises above its mean along z by more than the noise there allows, so that a pattern in all images
    // (dust on the sensor) does not pass for texture in focus. Where the limit does not tell them apart, a quarter of E
    // must persist, or the images' patterns be alike by half as those of the stack's strong texture are, and E be the
    // least energy. window_share: pixels of the window that lie in the image, over those of a whole window.
    bool exceeded_by(const focus::f64::CurveRecord& curve, double window_share) const;

    // The value that J / (f E) must exceed where the whole window lies in the image; 0: there is no limit.
    double least_ratio() const;

  private:
    double beyond_chance(double window_share) const; // excess of J - f E above its mean, over Q
    // Q of the images about the curve's maximum; independent: f E.
    double scale_of_chance(const focus::f64::CurveRecord& curve, double independent) const;
    // J if the images about the curve's maximum had the same pattern, each in its own strength.
    double all_alike(const focus::f64::CurveRecord& curve) const;

    IndependentImages independent_{};
    double normal_ =
        0; // standard normal value exceeded as rarely as noise may exceed the limit at one place of the scan
    std::vector<double> kept_; // f of every image
    double weight_ = 0;        // of an image; 0: curves are averaged
    double weight_beside_ = 0; // of its only neighbours
    double mean_kept_ = 0;
    std::optional<double> strong_texture_;
    double least_energy_ = 0;
};

} // namespace vkfv::topography
