// Quiet images of a stack, in which no texture comes into focus, found by second differences along z.
#pragma once

#include <vector>

namespace vkfv::topography {

// The value below which the smallest quarter of the values lies; at least one value.
double smallest_quarter(std::vector<double> values);

// The images whose second differences along z are noise, from the variances of the differences at image 1, 2, ... Where
// noise is least by chance it is also least correlated, so an image is judged not by its own difference but by those
// three images before and after, which share no image with it. Its own shows texture that is in focus in only one or
// two images. all: every image counts. variances: at least one; the result's numbers are those of images, from 1 on.
std::vector<int> quiet_images(const std::vector<double>& variances, bool all);

} // namespace vkfv::topography
