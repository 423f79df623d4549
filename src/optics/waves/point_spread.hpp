// The wave-optical point spread function, integrated over the traced pupil.
#pragma once

#include "optics/waves/wavefront.hpp"

#include <complex>
#include <span>
#include <utility>
#include <vector>

namespace vkfv::optics {

// The point spread function about the centre of the sphere that fits the wavefront best, so without piston and tilt.
// Radii and distances are in mm in the object, inversion removed, up to the `reach` for which it was made. PointWaves
// makes it.
class PointSpread {
  public:
    // A point of the pupil, with the amplitude of its piece of the pupil's area.
    struct Sample {
        glm::dvec2 p = glm::dvec2(0); // relative to the chief ray
        std::complex<double> amplitude;
    };
    struct Pupil {
        double wave_number = 0; // 2 pi / wavelength, 1/mm
        double scale = 0; // factor of the squared sum that makes its integral over the plane the wavelength's share
        double ideal_peak = 0; // 1/mm^2, value without aberration
        std::vector<Sample> samples;
    };
    PointSpread(std::vector<Pupil> pupils, glm::dvec2 centre, double reach)
        : pupils_(std::move(pupils)), centre_(centre), reach_(reach) {}

    glm::dvec2 centre() const { return centre_; }    // mm, relative to the middle wavelength's chief ray
    double value(glm::dvec2 from_centre) const;      // light per area, 1/mm^2; its integral is 1
    double ideal_peak() const;                       // value at the centre without aberrations
    double strehl() const;                           // value at the centre relative to ideal_peak()
    double around(double radius) const;              // mean value on a circle
    std::vector<double> dark_rings(int count) const; // radii of the first minima of around(), fewer beyond reach
    // The share of light within each of these ascending radii.
    std::vector<double> encircled(std::span<const double> radii) const;

  private:
    double ring_distance() const;

    std::vector<Pupil> pupils_;
    glm::dvec2 centre_;
    double reach_ = 0;
};

} // namespace vkfv::optics
