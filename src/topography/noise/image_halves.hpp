// Two means of images that share none, so that their noise is independent.
#pragma once

#include "topography/axial_average.hpp"

#include <vector>

namespace vkfv::topography {

// Both are near the mean of the weights around an image: one of its even and one of its odd neighbours, or the image
// and the one after it.
struct Halves {
    std::vector<Share> one, other;
};

// A pair with averages along z; without, one with the image before and one with the image after, where there are such.
std::vector<Halves> halves_at(const std::vector<double>& axial_weights, int at, int images);

} // namespace vkfv::topography
