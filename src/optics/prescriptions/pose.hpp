// The position and orientation of an element: a frame with its origin (mm) and axes, in the frame that contains it.
#pragma once

#include "optics/prescriptions/prescription.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace vkfv::optics {

struct Pose {
    glm::dvec3 origin = glm::dvec3(0);
    glm::dmat3 axes = glm::dmat3(1); // columns: x, y and z; orthonormal, left-handed behind an odd number of mirrors

    glm::dvec3 point(const glm::dvec3& inside) const { return origin + axes * inside; }
    glm::dvec3 direction(const glm::dvec3& inside) const { return axes * inside; }

    Pose along_z(double distance) const { return {point({0, 0, distance}), axes}; }
    // The frame decentred and tilted about its own origin; the thickness of the break is not applied.
    Pose turned(const CoordinateBreak& change) const;
    Pose after(const CoordinateBreak& change) const { return turned(change).along_z(change.thickness); }
    Pose along(const std::vector<CoordinateBreak>& changes) const; // the frame after all breaks in order
    // The frame for light of opposite direction: turned by half a turn about its own x axis.
    Pose half_turn() const { return {origin, glm::dmat3(axes[0], -axes[1], -axes[2])}; }
    // The mirror image of this frame in a mirror at z = 0 of the frame `mirror`.
    Pose mirrored_in(const Pose& mirror) const;
    // Transforms a pose from this frame into the frame that contains it.
    Pose place(const Pose& inside) const { return {point(inside.origin), axes * inside.axes}; }
};

} // namespace vkfv::optics
