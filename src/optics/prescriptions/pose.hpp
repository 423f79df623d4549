// Where an element stands: a frame with its origin (mm) and axes, in the frame that contains it.
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
    // Decentred and tilted about the own origin; without the thickness.
    Pose turned(const CoordinateBreak& change) const;
    Pose after(const CoordinateBreak& change) const { return turned(change).along_z(change.thickness); }
    Pose along(const std::vector<CoordinateBreak>& changes) const; // after each of them, in their order
    // For light the other way: half a turn about the own x axis.
    Pose half_turn() const { return {origin, glm::dmat3(axes[0], -axes[1], -axes[2])}; }
    // This one as it is seen in a mirror that stands in another's plane z = 0.
    Pose mirrored_in(const Pose& mirror) const;
    // `inside`, given in this frame, in the frame that this one is given in.
    Pose place(const Pose& inside) const { return {point(inside.origin), axes * inside.axes}; }
};

} // namespace vkfv::optics
