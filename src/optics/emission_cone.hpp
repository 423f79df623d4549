// The cone that a flat source within a disc is aimed into: it holds every ray that passes the illumination. mm.
#pragma once

#include "optics/first_order.hpp"

#include <span>

namespace vkfv::optics {

struct DiscSource {
    double radius = 0;
    double distance = 0;       // to the frame that the train is entered in
    bool monochromatic = true; // else light has every x of physics::Light
};

// Sine of the largest angle to the source's normal among sampled rays that pass the train; 0 if none does. May miss
// thin cones. `symmetric`: about the axis. `towards_stop`: the paraxial transfer from the source to the field stop,
// around whose centre rays are sampled.
double largest_sampled_sine(std::span<const physics::f64::Surface> train, bool symmetric, const DiscSource& source,
                            const RayTransfer& towards_stop);

// Sine of the half-angle of a cone about the source's normal. No ray outside it passes the train, which bounds prove
// (BundleTracer). As narrow as can be proved within a bounded time, but, to save time, not narrower than 1.02 times
// `known_sine`, the sine of a ray known to pass (0: none is known). 1, the hemisphere, if nothing narrower can be
// proved; 0 if nothing passes.
double emission_sine(std::span<const physics::f64::Surface> train, bool symmetric, const DiscSource& source,
                     double known_sine);

} // namespace vkfv::optics
