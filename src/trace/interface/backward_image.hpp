// The image that backward paths estimate.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "trace/interface/pixel_estimate.hpp"
#include "trace/interface/tracer.hpp"

#include <cstdint>

namespace vkfv::trace {

// How many paths each pixel has: `points` of one lattice in each of `randomisations`, whose scatter gives the standard
// error.
struct BackwardPlan {
    std::uint32_t randomisations = 2;
    std::uint32_t points = 1; // a power of two, at most 2^14
    std::uint64_t rays_per_pixel() const { return std::uint64_t{randomisations} * points; }
    physics::f64::Lattice lattice() const;
};

// No fewer than `rays` in all.
BackwardPlan backward_plan(std::uint64_t rays, ImageSize detector_pixels);
// How many these are.
std::uint64_t backward_rays(std::uint64_t rays, ImageSize detector_pixels);

// Of an instrument that was turned round, with the numbers of candidates that suit a material and the plan.
physics::f64::BackwardOptics backward_optics(const optics::Instrument& instrument,
                                             const physics::f64::Material& material, const BackwardPlan& plan);

// What the sums of backward paths stand for.
class BackwardAccounts {
  public:
    BackwardAccounts(const optics::Instrument& instrument, const BackwardPlan& plan);

    // Of the pixels' sums in each randomisation, of values in 1 / BACKWARD_UNIT.
    estimate::EstimateRule rule() const;
    // W on the detector for each unit of the sums of all randomisations.
    double power_per_number() const;
    // detected: W. It alone stands in the ledger: what becomes of the rest, backward paths do not see.
    Image image(PixelLight pixels, double detected) const;

  private:
    BackwardPlan plan_;
    double flux_;  // W, emitted
    double scale_; // W, of a pixel whose values' mean is 1
    ImageSize pixels_;
};

} // namespace vkfv::trace
