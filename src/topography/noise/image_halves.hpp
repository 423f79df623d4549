// Pairs of means of images that have no image in common, so that their noise is independent.
#pragma once

#include "topography/axial_average.hpp"

#include <vector>

namespace vkfv::topography {

// A pair of means, both near the mean of the weights around an image: one of its even and one of its odd neighbours, or
// the image and the one after it.
struct Halves {
    std::vector<Share> one, other;
};

// The pairs at an image: one pair with averages along z; without them, one with the image before and one with the image
// after, where these exist.
std::vector<Halves> halves_at(const std::vector<double>& axial_weights, int at, int images);

} // namespace vkfv::topography
