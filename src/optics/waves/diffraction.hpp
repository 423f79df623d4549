// Diffraction of an image, after the trace: geometric optics alone focuses too sharply.
#pragma once

#include "core/mathematics/grid.hpp"
#include "optics/waves/airy_pattern.hpp"

#include <complex>

namespace vkfv::optics {

// The incoherent image: the traced one convolved with the point spread function of the focused instrument, at every
// focal height alike. A traced pixel is the light of its area, so its spectrum holds the pixel's own transfer already
// and is multiplied by the pattern's alone; frequencies beyond a half cycle a pixel are not in it, so a point between
// coarse pixels rings by what they lack. Beyond the border the image continues as its mirror image, and no light is
// lost: the sum over the pixels stays the same (to rounding for the Airy pattern; for a measured point spread function
// but for what its asymmetry carries over the border).
class Diffraction {
  public:
    // For images of this size, pitch in mm in the object plane.
    Diffraction(const AiryPattern& pattern, int columns, int rows, double pitch);
    // A measured point spread function, its sum positive. Centred on its centroid, so that it does not shift images,
    // normalised, and collected over the image's pixels. Its pitch (mm in the object plane) may be finer than
    // the image's, not coarser: std::invalid_argument.
    Diffraction(const Grid<float>& point_spread, double point_spread_pitch, int columns, int rows, double pitch);

    // Of an image of that size.
    Grid<float> apply(const Grid<float>& image) const;

  private:
    Grid<float> apply_symmetric(const Grid<float>& image) const;
    Grid<float> apply_any(const Grid<float>& image) const;

    int columns_, rows_;
    Grid<double> symmetric_;         // at the frequencies of cosine_transform(); empty: any_ is used
    Grid<std::complex<double>> any_; // of the image and its mirror images, twice the size
};

} // namespace vkfv::optics
