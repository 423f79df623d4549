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

class PersistenceLimit {
  public:
    // No limit is set.
    PersistenceLimit() = default;
    // The limit that curves of noise alone exceed with the probability `rate`, wherever in the scan they have their
    // maximum. neighbour_weights: of an image's neighbours, by their distance. strong_texture: the share of energy that
    // persists where the stack's texture is strong, if it is known. least_energy: of E, where J does not tell texture
    // from noise (tells()).
    PersistenceLimit(const IndependentImages& independent, const std::vector<double>& neighbour_weights, int images,
                     double rate, std::optional<double> strong_texture = {}, double least_energy = 0);

    // False if nothing is known of the noise, or if its images are so often alike by chance that texture does not
    // exceed the limit. In the blank parts of compressed images only a few patterns are left, and in most images none.
    bool tells() const;

    // True if the energy that makes the curve's maximum persists: J exceeds the limit of noise alone, or half of E
    // persists; and S rises above its mean along z by more than the noise there allows, so that a pattern in all images
    // (dust on the sensor) does not pass for texture in focus. Where the limit does not tell them apart, a quarter of E
    // must persist and E be the least energy. window_share: pixels of the window that lie in the
    // image, over those of a whole window.
    bool exceeded_by(const focus::f64::CurveRecord& curve, double window_share) const;

    // The value that J / (f E) must exceed where the whole window lies in the image; 0: there is no limit.
    double least_ratio() const;

  private:
    double beyond_chance(double window_share) const; // excess of J / (f E) above its mean

    IndependentImages independent_{};
    double normal_ =
        0; // standard normal value exceeded as rarely as noise may exceed the limit at one place of the scan
    std::vector<double> kept_; // f of every image
    double mean_kept_ = 0;
    std::optional<double> strong_texture_;
    double least_energy_ = 0;
};

} // namespace vkfv::topography
