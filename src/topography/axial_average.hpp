// The Gaussian average along z: image k becomes a weighted mean of images k + d, |d| <= 3 s, with weights exp(-d^2 / (2 s^2))
// (1 % at the rim). At the ends of the stack, where images are missing on one side, a straight line is fitted with these
// weights and its value at k taken (local linear regression; Fan and Gijbels, "Local Polynomial Modelling and Its
// Applications", 1996, chapter 2): the mean of those present would be of images further inside, which moves peaks near
// an end towards it.
#pragma once

#include <vector>

namespace vkfv::topography {

// weights[d] of an image d steps away, d = 0..radius; not normalised. s in images; 0: the image itself alone.
std::vector<double> axial_weights(double standard_deviation);

// What an image contributes to a weighted mean.
struct Share {
    int image;
    float weight; // all of one mean add up to one; some are negative at the ends
};

// The average at image `at` of a stack of `images`, in ascending order of the images.
std::vector<Share> axial_shares(const std::vector<double>& weights, int at, int images);

// Of each image: the variance of the focus curve after both averages, first of the images, then of the curve, over that of
// the measure of single images. Averaged images i and j share noise with the covariance c of their weights, and the
// measure, quadratic in the noise, varies together by c^2.
std::vector<double> averaged_variances(const std::vector<double>& weights, int images);

} // namespace vkfv::topography
