// Plan and accounts of the image that the backward estimator makes.
#pragma once

#include "optics/instrument/instrument.hpp"
#include "trace/interface/pixel_estimate.hpp"
#include "trace/interface/tracer.hpp"

#include <cstdint>

namespace vkfv::trace {

// The number of paths of each pixel: `points` of one lattice in each of `randomisations`, whose scatter gives the
// standard error.
struct BackwardPlan {
    std::uint32_t randomisations = 2;
    std::uint32_t points = 1; // a power of two, at most 2^14
    std::uint64_t rays_per_pixel() const { return std::uint64_t{randomisations} * points; }
    physics::f64::Lattice lattice() const;
};

// The plan with at least `rays` paths in all.
BackwardPlan backward_plan(std::uint64_t rays, ImageSize detector_pixels);
// The number of paths of that plan.
std::uint64_t backward_rays(std::uint64_t rays, ImageSize detector_pixels);

// The optics of backward paths of a reversed instrument, with the numbers of candidates that suit a material and the
// plan.
physics::f64::BackwardOptics backward_optics(const optics::Instrument& instrument,
                                             const physics::f64::Material& material, const BackwardPlan& plan);

// Converts the sums of backward paths to light.
class BackwardAccounts {
  public:
    BackwardAccounts(const optics::Instrument& instrument, const BackwardPlan& plan);

    // The rule for the pixels' sums in each randomisation, of values in units of 1 / BACKWARD_UNIT.
    estimate::EstimateRule rule() const;
    // W on the detector for each unit of the sums of all randomisations.
    double power_per_number() const;
    // The image with its ledger. detected: W, the only entry besides the rest, since backward paths do not see other
    // fates.
    Image image(PixelLight pixels, double detected) const;

  private:
    BackwardPlan plan_;
    double flux_;  // W, emitted
    double scale_; // W of a pixel whose values have the mean 1
    ImageSize pixels_;
};

} // namespace vkfv::trace
