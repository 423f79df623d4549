// The Gaussian average along z: image k becomes the mean of images k + d with weights exp(-d^2 / (2 s^2)), |d| <= 3 s
// (where the weight is 1 %), over the existing images: at the ends of the stack the weights present are normalised to
// one. There the mean stands for a place further inside, which averaged_points() gives, and averages less
// (places_of_maxima.hpp). (A local line instead of the mean would stand for k itself, but with several times the noise,
// whose energy passes for texture: weak texture in the middle of the scan would be lost.)
#pragma once

#include <vector>

namespace vkfv::topography {

// weights[d]: of an image d steps away, d = 0..radius; not normalised. standard_deviation: in images; 0: no average.
std::vector<double> axial_weights(double standard_deviation);

// The weight of an image in a mean.
struct Share {
    int image;
    float weight; // the weights of one mean add up to one
};

// The shares of the average at image `at` of a stack of `images`, in ascending order of the images.
std::vector<Share> axial_shares(const std::vector<double>& weights, int at, int images);

// The shares of means that all have the same noise: at the ends, where images lie on one side only, the Gaussian is
// wider and averages as much as elsewhere. A focus measure takes noise for texture: with axial_shares() a curve of
// noise alone rises towards both ends, to sqrt(2) of its value elsewhere.
std::vector<Share> even_shares(const std::vector<double>& weights, int at, int images);

// The weights of all images, in their order, in the curve's point `at` after both averages.
std::vector<double> twice_averaged(const std::vector<double>& weights, int at, int images);

// A point of the focus curve after both averages, first of the images, then of the curve.
struct AveragedPoint {
    double position = 0; // in steps of the scan, at which a straight line has the averaged value
    // Variance over that of single images' measures, which are linear in small noise beside texture. (Noise alone
    // correlates less from image to image: an upper bound.)
    double variance = 0;
};
std::vector<AveragedPoint> averaged_points(const std::vector<double>& weights, int images);

} // namespace vkfv::topography
