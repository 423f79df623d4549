// Diffraction of an image after the trace, as geometric optics alone gives too sharp a focus.
#pragma once

#include "core/mathematics/grid.hpp"
#include "optics/waves/airy_pattern.hpp"

#include <complex>

namespace vkfv::optics {

// The incoherent image: the traced image convolved with the point spread function of the focused instrument, at every
// focal height alike. A traced pixel collects the light of its area, so its spectrum contains the pixel's own transfer
// function already and is multiplied by the pattern's alone. Frequencies beyond half a cycle a pixel are missing, so a
// point between coarse pixels shows ringing. Beyond the border the image continues as its mirror image, and no light is
// lost: the sum over the pixels is conserved (to rounding for the Airy pattern; for a measured point spread function
// except for light that its asymmetry carries over the border).
class Diffraction {
  public:
    // The Airy pattern, for images of this size; pitch: mm in the object plane.
    Diffraction(const AiryPattern& pattern, int columns, int rows, double pitch);
    // A measured point spread function, with a positive sum. It is centred on its centroid, so that it does not shift
    // images, normalised, and integrated over the image's pixels. Its pitch (mm in the object plane) may be finer than
    // the image's; std::invalid_argument if it is coarser.
    Diffraction(const Grid<float>& point_spread, double point_spread_pitch, int columns, int rows, double pitch);

    // The diffracted image; `image` has the size given to the constructor.
    Grid<float> apply(const Grid<float>& image) const;

  private:
    Grid<float> apply_symmetric(const Grid<float>& image) const;
    Grid<float> apply_any(const Grid<float>& image) const;

    int columns_, rows_;
    Grid<double> symmetric_;         // transfer function at the frequencies of cosine_transform(); empty: any_ is used
    Grid<std::complex<double>> any_; // transfer function for image and mirror images, twice the size
};

} // namespace vkfv::optics
