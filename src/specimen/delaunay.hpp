// The Delaunay triangulation of points in a plane.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace vkfv::specimen {

struct DelaunayTriangulation {
    std::vector<glm::uvec3> triangles; // indices of points, counter-clockwise; empty: all points lie on a line
    // For each point the first one at its place, which stands for it in the triangles: itself if there is no other.
    std::vector<std::uint32_t> place;
};

// No point lies within the circle through the corners of a triangle. Where more than three lie on one circle, the
// triangles of that polygon share the point whose index is lowest. Points are told apart, and the circles are exact, on
// a grid of 2^-32 of the larger extent along x or y. Slivers at the border, of points that lie on a line but for
// rounding, are left out: thinner than `thinnest_sliver` times their length. The same points give the same triangles.
// points: finite, of any unit.
DelaunayTriangulation delaunay(std::span<const glm::dvec2> points);

inline constexpr double thinnest_sliver = 1e-6;

} // namespace vkfv::specimen
