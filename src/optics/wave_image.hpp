// The image of a point by waves, integrated over the traced pupil: no transforms, no cells. Incoherent light, scalar
// waves, a pupil of even radiance in direction cosines (a Lambertian specimen's). Lengths in mm in the object,
// inversion removed.
#pragma once

#include "optics/wavefront.hpp"

#include <complex>
#include <span>
#include <utility>
#include <vector>

namespace vkfv::optics {

// The transfer function of one wavelength (H. H. Hopkins, Proc. Roy. Soc. A 231 (1955) 91) at a frequency in cycles per
// mm; A: the pupil's area:
//   H(f) = (1 / A) integral of exp(-i k (W(p + lambda f / 2) - W(p - lambda f / 2))) over the p of which both pass.
// H(f) is the integral of the point spread times exp(-2 pi i f . x), 1 at 0. Pupils are taken for convex.
std::complex<double> transfer(const Wavefront& wavefront, glm::dvec2 frequency);

// The point spread function, about the centre of the sphere that fits the wavefront best: that without piston and tilt.
// Radii and ways in mm, up to the `reach` that it was made for.
class PointSpread {
  public:
    // Of one wavelength.
    struct Sample {
        glm::dvec2 p = glm::dvec2(0); // from the chief ray
        std::complex<double> amplitude;
    };
    struct Pupil {
        double wave_number = 0; // 2 pi / wavelength, 1/mm
        double scale = 0;       // of the squared sum, so that its integral over the plane is the wavelength's share
        double ideal_peak = 0;  // without aberration, 1/mm^2
        std::vector<Sample> samples;
    };
    PointSpread(std::vector<Pupil> pupils, glm::dvec2 centre, double reach)
        : pupils_(std::move(pupils)), centre_(centre), reach_(reach) {}

    glm::dvec2 centre() const { return centre_; }    // from where the middle wavelength's chief ray lands
    double value(glm::dvec2 from_centre) const;      // light per area, 1/mm^2; its integral is 1
    double ideal_peak() const;                       // the value in the centre without aberrations
    double strehl() const;                           // the value in the centre over that without aberrations
    double around(double radius) const;              // mean of the values on a circle
    std::vector<double> dark_rings(int count) const; // radii of the first minima of that, as far as there are
    // The light within each of these ascending radii.
    std::vector<double> encircled(std::span<const double> radii) const;

  private:
    double ring_distance() const;

    std::vector<Pupil> pupils_;
    glm::dvec2 centre_;
    double reach_ = 0;
};

// All wavelengths of one point of the field.
class WaveImage {
  public:
    // A continuous spectrum by at most `most` wavelengths.
    explicit WaveImage(const Instrument& instrument, glm::dvec2 field = glm::dvec2(0), int most = 9);
    explicit WaveImage(std::vector<Wavefront> wavefronts) : wavefronts_(std::move(wavefronts)) {}

    WaveImage at_height(double height) const; // of the object plane above z = 0

    const std::vector<Wavefront>& wavefronts() const { return wavefronts_; }
    const Wavefront& middle() const;                           // the wavelength in the middle of the flux
    glm::dvec2 aside(const Wavefront& wavefront) const;        // where its chief ray lands beside the middle one's, mm
    double cutoff() const;                                     // no higher frequency is transferred
    std::complex<double> transfer(glm::dvec2 frequency) const; // weighted by flux, with lateral colour
    // For points up to `reach` (mm) from the centre.
    PointSpread point_spread(double reach) const;

  private:
    std::vector<Wavefront> wavefronts_;
};

} // namespace vkfv::optics
