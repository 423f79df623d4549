// The image of a point by waves, over the spectrum. Lengths in mm in the object, inversion removed.
#pragma once

#include "optics/waves/point_spread.hpp"
#include "optics/waves/wavefront.hpp"

#include <complex>
#include <utility>
#include <vector>

namespace vkfv::optics {

// Figures and pictures of a continuous spectrum are computed for at most so many wavelengths.
inline constexpr int wavelengths_of_figures = 5;

// All wavelengths of one point of the field.
class PointWaves {
  public:
    // A continuous spectrum by at most `most` wavelengths.
    explicit PointWaves(const Instrument& instrument, glm::dvec2 field = glm::dvec2(0), int most = 9);
    explicit PointWaves(std::vector<Wavefront> wavefronts) : wavefronts_(std::move(wavefronts)) {}

    PointWaves at_height(double height) const; // of the object plane above z = 0

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
