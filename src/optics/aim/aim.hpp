// The directions that a flat source within a disc is aimed into: they hold every ray that passes the illumination. mm.
#pragma once

#include "optics/train/first_order.hpp"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace vkfv::optics {

struct DiscSource {
    double radius = 0;
    double distance = 0;       // to the frame that the train is entered in
    bool monochromatic = true; // else light has every x of physics::Light
};

// By their cosines across the source's normal, directions within a disc (shaders/physics/source.glsl): about `shift`
// times the place at the source, of radius `sine`. The whole hemisphere: 0 and 1.
struct Aim {
    double shift = 0; // 1/mm
    double sine = 1;
};

// A ray on the rim of what passes, by its place and its direction's cosines across the normal.
struct RimRay {
    glm::dvec2 position{0};
    glm::dvec2 cosines{0};
};

// Sampled rays that pass the train, about the largest angles to the source's normal; none if none passes. May miss thin
// cones. `symmetric`: about the axis. `towards_stop`: the paraxial transfer from the source to the field stop, around
// whose centre rays are sampled.
std::vector<RimRay> sampled_rim(std::span<const physics::f64::Surface> train, bool symmetric, const DiscSource& source,
                                const RayTransfer& towards_stop);

// The smallest disc of this shift that holds them; its sine is 0 if there are none.
Aim aim_at(std::span<const RimRay> rim, double shift);

// An aim that holds every ray which passes the train, as bounds prove (BundleTracer). `known` has its shift, and the
// sine that rays known to pass have with it (0: none is known): to save time, the aim's is not less than 1.02 times
// that. Otherwise it is as small as can be proved within a bounded time, and 0 if nothing passes. `reach`: the sine of
// a cone about the normal that is known to hold everything.
Aim proved_aim(std::span<const physics::f64::Surface> train, bool symmetric, const DiscSource& source, const Aim& known,
               double reach = 1);

// The better of two: about the normal, and about the middle of the rim from each place. Always within the hemisphere.
Aim best_aim(std::span<const physics::f64::Surface> train, bool symmetric, const DiscSource& source,
             std::span<const RimRay> rim);

} // namespace vkfv::optics
