// Registration of the images of a stack: an instrument's lens breathes and its stage drifts, so that a point of the
// specimen moves from image to image.
#pragma once

#include "topography/focus_measure.hpp"

#include <span>
#include <vector>

namespace vkfv::topography {

enum class Registration { none, shift, shift_and_scale };

// The positions of a reference image's points in another image: middle + scale (point - middle) + shift, in pixels.
struct ImageTransform {
    double shift_x = 0;
    double shift_y = 0;
    double scale = 1;

    ImageTransform then(const ImageTransform& next) const; // the reference, seen through both
    ImageTransform inverse() const;
};

// The transform by phase correlation (C. D. Kuglin and D. C. Hines, "The phase correlation image alignment method",
// 1975), to a fraction of a pixel: a shift from the whole images, a scale from nine overlapping parts, as the slope of
// their shifts. Shifts of up to a quarter of the image, or of a part, are found. Both images have one size.
ImageTransform registered(const Grid<float>& reference, const Grid<float>& image, Registration what);

// Shift and scale with their standard deviations, from the disagreement of the parts' shifts.
struct MeasuredTransform {
    ImageTransform transform{};
    double shift_deviation = 0; // pixels, for either component
    double scale_deviation = 0;
};
MeasuredTransform measured_transform(const Grid<float>& reference, const Grid<float>& image);

// Combines the transforms from each image's neighbour, in their order, to transforms from the frame of the image in the
// middle.
std::vector<ImageTransform> in_common_frame(std::span<const ImageTransform> from_neighbour);

// The image in the reference's frame, by cubic convolution (R. G. Keys, 1981, a = -1/2); beyond the image its border is
// repeated.
Channels resampled(const Channels& image, const ImageTransform& transform);

} // namespace vkfv::topography
