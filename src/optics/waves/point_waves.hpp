// The wave-optical image of a point, over the spectrum. Lengths in mm in the object, inversion removed.
#pragma once

#include "optics/waves/point_spread.hpp"
#include "optics/waves/wavefront.hpp"

#include <complex>
#include <utility>
#include <vector>

namespace vkfv::optics {

// The largest number of wavelengths that stand for a continuous spectrum in figures and pictures.
inline constexpr int wavelengths_of_figures = 5;

// The wavefronts of one point of the field at all wavelengths.
class PointWaves {
  public:
    // Traces the point; a continuous spectrum is represented by at most `most` wavelengths.
    explicit PointWaves(const Instrument& instrument, glm::dvec2 field = glm::dvec2(0), int most = 9);
    explicit PointWaves(std::vector<Wavefront> wavefronts) : wavefronts_(std::move(wavefronts)) {}

    PointWaves at_height(double height) const; // at this height (mm) of the object plane above z = 0

    const std::vector<Wavefront>& wavefronts() const { return wavefronts_; }
    const Wavefront& middle() const;                           // the wavefront in the middle of the flux
    glm::dvec2 aside(const Wavefront& wavefront) const;        // mm, its chief ray relative to that of middle()
    double cutoff() const;                                     // frequency above which nothing is transferred
    std::complex<double> transfer(glm::dvec2 frequency) const; // weighted by flux, with lateral colour
    // The point spread function for points up to `reach` (mm) from the centre.
    PointSpread point_spread(double reach) const;

  private:
    std::vector<Wavefront> wavefronts_;
};

} // namespace vkfv::optics
