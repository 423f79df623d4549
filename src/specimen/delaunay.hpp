// The Delaunay triangulation of points in a plane.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace vkfv::specimen {

struct DelaunayTriangulation {
    std::vector<glm::uvec3> triangles; // indices of points, counter-clockwise; empty if all points lie on a line
    // For each point the first point at the same place, which represents it in the triangles; the point itself if it is
    // the first.
    std::vector<std::uint32_t> place;
};

// Triangulates points (finite, in any unit) so that no point lies within the circle through the corners of a triangle.
// Where more than three lie on one circle, the triangles of that polygon share the point of the lowest index. Points
// are distinguished, and the circles are exact, on a grid of 2^-32 of the larger extent along x or y. Slivers at the
// border, thinner than `thinnest_sliver` times their length, are left out, as their points lie on a line except for
// rounding. The result depends on the points alone.
DelaunayTriangulation delaunay(std::span<const glm::dvec2> points);

inline constexpr double thinnest_sliver = 1e-6;

} // namespace vkfv::specimen
