// The cone that a disc source is aimed into: it holds every ray that passes the illumination. Lengths in mm.
#pragma once

#include "optics/first_order.hpp"

#include <span>

namespace vkfv::optics {

struct DiscSource {
    double radius = 0;
    double distance = 0;       // to the frame that the train is entered in
    bool monochromatic = true; // else light has every x of physics::Light
};

// Sine of the largest angle against the source's normal among samples of its light that pass the train, 0: none does.
// It may miss thin cones. `symmetric`: about the axis. `towards_stop` leads, paraxially, from the source to the field
// stop, whose centre samples are taken about.
double largest_sampled_sine(std::span<const physics::f64::Surface> train, bool symmetric, const DiscSource& source,
                            const RayTransfer& towards_stop);

// Sine of the half-angle of a cone about the source's normal that no light leaves outside of and passes the train:
// proved by bounds (BundleTracer), not found by samples. As narrow as that allows within a bounded time, but not
// narrower than 1.02 times `known_sine`, of light that is known to pass (0: of none), which saves time. 1, the
// hemisphere, where nothing narrower can be proved; 0: nothing passes.
double emission_sine(std::span<const physics::f64::Surface> train, bool symmetric, const DiscSource& source,
                     double known_sine);

} // namespace vkfv::optics
