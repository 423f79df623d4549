#include "optics/prescriptions/pose.hpp"

#include <cmath>

namespace vkfv::optics {

namespace {

// The right-handed rotation by an angle (rad) about one coordinate axis; its columns are the new axes.
glm::dmat3 turn(int axis, double angle) {
    const int next = (axis + 1) % 3;
    const int third = (axis + 2) % 3;
    glm::dmat3 result(1);
    result[next][next] = std::cos(angle);
    result[next][third] = std::sin(angle);
    result[third][next] = -std::sin(angle);
    result[third][third] = std::cos(angle);
    return result;
}

} // namespace

Pose Pose::turned(const CoordinateBreak& change) const {
    const glm::dvec3 decentre(change.decentre_x, change.decentre_y, 0);
    const glm::dmat3 x = turn(0, change.tilt_x);
    const glm::dmat3 y = turn(1, change.tilt_y);
    const glm::dmat3 z = turn(2, change.tilt_z);
    if (change.tilt_first) {
        const glm::dmat3 tilted = axes * z * y * x;
        return {origin + tilted * decentre, tilted};
    }
    return {point(decentre), axes * x * y * z};
}

Pose Pose::along(const std::vector<CoordinateBreak>& changes) const {
    Pose pose = *this;
    for (const CoordinateBreak& change : changes) {
        pose = pose.after(change);
    }
    return pose;
}

Pose Pose::mirrored_in(const Pose& mirror) const {
    const glm::dvec3 normal = mirror.axes[2];
    const auto reflect = [&](const glm::dvec3& v) { return v - 2 * glm::dot(v, normal) * normal; };
    return {mirror.origin + reflect(origin - mirror.origin),
            glm::dmat3(reflect(axes[0]), reflect(axes[1]), reflect(axes[2]))};
}

} // namespace vkfv::optics
