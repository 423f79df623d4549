// The image of a point by diffraction at the pupil.
#pragma once

#include "optics/media/spectrum.hpp"

#include <vector>

namespace vkfv::optics {

// The incoherent optical transfer function of an aberration-free system with a circular pupil,
//   (2 / pi) (acos s - s sqrt(1 - s^2)),  s = frequency / cutoff,
// which is 0 from the cutoff upwards (J. W. Goodman, "Introduction to Fourier Optics", section on the transfer function
// of a circular aperture).
double circular_pupil_transfer(double frequency, double cutoff);

// The Airy pattern in the object plane, averaged over a spectrum by the flux of its bins, each represented by its
// middle.
class AiryPattern {
  public:
    AiryPattern(double numerical_aperture, const Spectrum& spectrum);

    // The transfer function at a frequency in cycles per mm in the object plane; 1 at 0.
    double transfer(double frequency) const;
    // The cutoff 2 NA / wavelength of the shortest wavelength, in cycles per mm.
    double cutoff() const;

  private:
    struct Line {
        double cutoff = 0;
        double share = 0;
    };
    std::vector<Line> lines_;
};

} // namespace vkfv::optics
