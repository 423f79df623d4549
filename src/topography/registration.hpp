// Images of a stack laid over each other: an instrument's lens breathes and its stage drifts, so that a point of the
// specimen wanders from image to image.
#pragma once

#include "topography/focus_measure.hpp"

#include <span>
#include <vector>

namespace vkfv::topography {

enum class Registration { none, shift, shift_and_scale };

// Where the points of a reference image stand in another: middle + scale (point - middle) + shift, in pixels.
struct ImageTransform {
    double shift_x = 0;
    double shift_y = 0;
    double scale = 1;

    ImageTransform then(const ImageTransform& next) const; // of the reference, seen through both
    ImageTransform inverse() const;
};

// By phase correlation (C. D. Kuglin and D. C. Hines, "The phase correlation image alignment method", 1975), to a
// fraction of a pixel: of the whole images for a shift, of nine overlapping parts for a scale, which is the slope of
// their shifts. Shifts of up to a quarter of the image, or of a part, are found. Images of one size.
ImageTransform registered(const Grid<float>& reference, const Grid<float>& image, Registration what);

// Shift and scale with their standard deviations, by what the parts' shifts do not agree on.
struct MeasuredTransform {
    ImageTransform transform{};
    double shift_deviation = 0; // pixels, of either component
    double scale_deviation = 0;
};
MeasuredTransform measured_transform(const Grid<float>& reference, const Grid<float>& image);

// Each image against its neighbour, in their order, and all in the frame of the one in the middle.
std::vector<ImageTransform> in_common_frame(std::span<const ImageTransform> from_neighbour);

// The image in the reference's frame, by cubic convolution (R. G. Keys, 1981, a = -1/2); what lies beyond it repeats
// its border.
Channels resampled(const Channels& image, const ImageTransform& transform);

} // namespace vkfv::topography
