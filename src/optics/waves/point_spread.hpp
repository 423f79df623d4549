// A point spread function by waves, integrated over the traced pupil.
#pragma once

#include "optics/waves/wavefront.hpp"

#include <complex>
#include <span>
#include <utility>
#include <vector>

namespace vkfv::optics {

// The point spread function, about the centre of the sphere that fits the wavefront best: that without piston and tilt.
// Radii and ways in mm in the object, inversion removed, up to the `reach` that it was made for. PointWaves makes it.
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

} // namespace vkfv::optics
