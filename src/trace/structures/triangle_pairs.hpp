// Triangles in pairs, as shaders/device/specimen_bvh.glsl meets them.
#pragma once

#include "vulkan/acceleration_structure.hpp"

#include <glm/glm.hpp>

#include <array>
#include <span>
#include <vector>

namespace vkfv::trace {

// The triangles (0, 1, 2) and (0, 2, 3) of these corners; a single triangle repeats corner 0 as corner 3. A pair halves
// the primitives and fetches two thirds of the corners, which limit random rays through many triangles.
struct TrianglePair {
    std::array<glm::vec3, 4> corners;

    vulkan::Box box() const;
};
static_assert(sizeof(TrianglePair) == 12 * 4);

// Pairs each triangle once, with the unpaired neighbour over an edge that makes the smallest box with it. Neighbours
// share indices of vertices; the orientation of a triangle is not kept.
std::vector<TrianglePair> pair_triangles(std::span<const glm::vec3> vertices, std::span<const glm::uvec3> triangles);

} // namespace vkfv::trace
