// Images of a stack in which no texture comes into focus, told by second differences along z.
#pragma once

#include <vector>

namespace vkfv::topography {

// The limit of the smallest quarter of the values; at least one value.
double smallest_quarter(std::vector<double> values);

// The images whose second differences along z are noise, by the variances of those of image 1, 2, ... Noise is least
// correlated where it is least by chance: what decides is not an image's own difference but those three images before
// and after, which share no image with it. Its own tells texture that is in focus in an image or two.
// all: every image counts. At least one variance; the result's numbers are those of images, from 1 on.
std::vector<int> quiet_images(const std::vector<double>& variances, bool all);

} // namespace vkfv::topography
