// Triangles two by two, as shaders/device/specimen_bvh.glsl meets them.
#pragma once

#include "vulkan/acceleration_structure.hpp"

#include <glm/glm.hpp>

#include <array>
#include <span>
#include <vector>

namespace vkfv::trace {

// The triangles (0, 1, 2) and (0, 2, 3) of these corners; one alone repeats corner 0 as corner 3. Half the primitives
// and two thirds of the corners to be fetched: what random rays through many triangles are bound by.
struct TrianglePair {
    std::array<glm::vec3, 4> corners;

    vulkan::Box box() const;
};
static_assert(sizeof(TrianglePair) == 12 * 4);

// Each triangle once, together with the unpaired neighbour over an edge that makes the smallest box with it. Neighbours
// share indices of vertices; which way round a triangle goes is not kept.
std::vector<TrianglePair> pair_triangles(std::span<const glm::vec3> vertices, std::span<const glm::uvec3> triangles);

} // namespace vkfv::trace
