// The Gaussian average along z: image k becomes the mean of images k + d with weights exp(-d^2 / (2 s^2)), |d| <= 3 s
// (where the weight is 1 %), over the images there are: at the ends of the stack the weights present are normalised to
// one.
#pragma once

#include <vector>

namespace vkfv::topography {

// weights[d] of an image d steps away, d = 0..radius; not normalised. s in images; 0: the image itself alone.
std::vector<double> axial_weights(double standard_deviation);

// What an image contributes to a weighted mean.
struct Share {
    int image;
    float weight; // all of one mean add up to one
};

// The average at image `at` of a stack of `images`, in ascending order of the images.
std::vector<Share> axial_shares(const std::vector<double>& weights, int at, int images);

} // namespace vkfv::topography
