// The directions into which a flat source within a disc emits: they contain every ray that passes the illumination.
// Lengths in mm.
#pragma once

#include "optics/train/first_order.hpp"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace vkfv::optics {

struct DiscSource {
    double radius = 0;
    double distance = 0;       // distance to the frame in which light enters the train
    bool monochromatic = true; // false: light has every x of physics::Light
};

// The directions of emission: a disc in direction cosines transverse to the source's normal
// (shaders/physics/source.glsl), with its centre at `shift` times the position on the source and the radius `sine`. The
// whole hemisphere has shift 0 and sine 1.
struct Aim {
    double shift = 0; // 1/mm
    double sine = 1;
};

// A ray on the rim of the passing light: its position (mm) and its direction cosines transverse to the normal.
struct RimRay {
    glm::dvec2 position{0};
    glm::dvec2 cosines{0};
};

// Sampled rays that pass the train, at about the largest angles to the source's normal; empty if none passes. Thin
// cones may be missed. `symmetric`: the train is rotationally symmetric. `towards_stop`: the paraxial transfer from the
// source to the field stop, around whose centre rays are sampled.
std::vector<RimRay> sampled_rim(std::span<const physics::f64::Surface> train, bool symmetric, const DiscSource& source,
                                const RayTransfer& towards_stop);

// The smallest disc of this shift that contains the rays; its sine is 0 if there are none.
Aim aim_at(std::span<const RimRay> rim, double shift);

// An aim that contains every ray which passes the train, as bounds prove (BundleTracer). `known` gives the shift, and
// the sine that rays known to pass have with it (0: none is known): to save time, the result's sine is at least 1.02
// times that. Otherwise it is as small as can be proved within a bounded time, and 0 if nothing passes. `reach`: the
// sine of a cone about the normal that is known to contain all passing light.
Aim proved_aim(std::span<const physics::f64::Surface> train, bool symmetric, const DiscSource& source, const Aim& known,
               double reach = 1);

// The smaller of two proved aims: one about the normal, one about the centre of the rim as it moves with the position.
// The result lies within the hemisphere.
Aim best_aim(std::span<const physics::f64::Surface> train, bool symmetric, const DiscSource& source,
             std::span<const RimRay> rim);

} // namespace vkfv::optics
