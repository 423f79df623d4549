#include "specimen/delaunay.hpp"

#include <boost/polygon/voronoi.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vkfv::specimen {
namespace {

// Boost.Polygon's predicates are exact for 32-bit integer coordinates, and only for these.
using GridPoint = boost::polygon::point_data<std::int32_t>;
using Voronoi = boost::polygon::voronoi_diagram<double>;
using Vertex = Voronoi::vertex_type;
using Edge = Voronoi::edge_type;

std::vector<GridPoint> on_grid(std::span<const glm::dvec2> points) {
    glm::dvec2 lower(std::numeric_limits<double>::infinity());
    glm::dvec2 upper = -lower;
    for (const glm::dvec2& point : points) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    // Both axes have the same scale, so that circles stay circles.
    constexpr double largest = std::numeric_limits<std::int32_t>::max();
    const glm::dvec2 middle = 0.5 * lower + 0.5 * upper;
    const glm::dvec2 halves = 0.5 * upper - 0.5 * lower; // finite even where upper - lower would overflow
    const double half = std::max(halves.x, halves.y);
    const auto coordinate = [&](double offset) {
        return half > 0 ? static_cast<std::int32_t>(std::lround(std::clamp(offset / half, -1.0, 1.0) * largest)) : 0;
    };
    std::vector<GridPoint> grid;
    grid.reserve(points.size());
    for (const glm::dvec2& point : points) {
        grid.emplace_back(coordinate(point.x - middle.x), coordinate(point.y - middle.y));
    }
    return grid;
}

bool same_place(const GridPoint& a, const GridPoint& b) {
    return a.x() == b.x() && a.y() == b.y();
}

// The indices of the first point at each place, in ascending order; fills `place` of DelaunayTriangulation.
std::vector<std::uint32_t> distinct(const std::vector<GridPoint>& grid, std::vector<std::uint32_t>& place) {
    std::vector<std::uint32_t> order(grid.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
        const GridPoint &p = grid[a], &q = grid[b];
        return p.x() != q.x() ? p.x() < q.x() : p.y() != q.y() ? p.y() < q.y() : a < b;
    });
    place.resize(grid.size());
    std::vector<std::uint32_t> first;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool repeats = k > 0 && same_place(grid[order[k]], grid[order[k - 1]]);
        place[order[k]] = repeats ? place[order[k - 1]] : order[k];
        if (!repeats) {
            first.push_back(order[k]);
        }
    }
    std::ranges::sort(first);
    return first;
}

bool is_sliver(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    const auto to = [](const GridPoint& from, const GridPoint& point) {
        return glm::dvec2(static_cast<double>(point.x()) - from.x(), static_cast<double>(point.y()) - from.y());
    };
    const glm::dvec2 ab = to(a, b), bc = to(b, c), ca = to(c, a);
    const double longest_squared = std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)});
    return ab.x * bc.y - ab.y * bc.x <= thinnest_sliver * longest_squared;
}

// The triangles around the vertices of a Voronoi diagram. A vertex is the centre of the circle through the points
// around it: the corners of a triangle, or of a polygon if more of them lie on the circle.
class Circles {
  public:
    Circles(const std::vector<GridPoint>& grid, const std::vector<std::uint32_t>& points)
        : grid_(grid), points_(points) {
        std::vector<GridPoint> sites;
        sites.reserve(points.size());
        for (const std::uint32_t point : points) {
            sites.push_back(grid[point]);
        }
        boost::polygon::construct_voronoi(sites.begin(), sites.end(), &diagram_);
    }

    std::vector<glm::uvec3> triangles() {
        peel();
        std::vector<glm::uvec3> result;
        result.reserve(diagram_.num_vertices());
        for (const Vertex& vertex : diagram_.vertices()) {
            if (vertex.color() != peeled) {
                append(vertex, result);
            }
        }
        return result;
    }

  private:
    static constexpr Vertex::color_type seen = 1, peeled = 2;

    // Marks slivers as peeled, from the border inwards, until none is left there.
    void peel() {
        std::vector<const Vertex*> border;
        const auto reach = [&](const Vertex* vertex) {
            if (vertex != nullptr && vertex->color() == 0) {
                vertex->color(seen);
                border.push_back(vertex);
            }
        };
        for (const Edge& edge : diagram_.edges()) {
            if (edge.vertex1() == nullptr) {
                reach(edge.vertex0());
            }
        }
        std::vector<glm::uvec3> polygon;
        while (!border.empty()) {
            const Vertex& vertex = *border.back();
            border.pop_back();
            polygon.clear();
            append(vertex, polygon);
            if (std::ranges::all_of(polygon, [&](const glm::uvec3& triangle) {
                    return is_sliver(grid_[triangle.x], grid_[triangle.y], grid_[triangle.z]);
                })) {
                vertex.color(peeled);
                around(vertex, [&](const Edge& edge) { reach(edge.vertex1()); });
            }
        }
    }

    template <class Use>
    static void around(const Vertex& vertex, Use use) {
        const Edge* edge = vertex.incident_edge();
        do {
            use(*edge);
            edge = edge->rot_next();
        } while (edge != vertex.incident_edge());
    }

    // Appends the triangles of the polygon around a vertex; they share the point of the lowest index.
    void append(const Vertex& vertex, std::vector<glm::uvec3>& triangles) {
        corners_.clear();
        around(vertex, [&](const Edge& edge) { corners_.push_back(points_[edge.cell()->source_index()]); });
        std::rotate(corners_.begin(), std::ranges::min_element(corners_), corners_.end());
        for (std::size_t k = 2; k < corners_.size(); ++k) {
            triangles.emplace_back(corners_[0], corners_[k - 1], corners_[k]);
        }
    }

    const std::vector<GridPoint>& grid_;
    const std::vector<std::uint32_t>& points_;
    Voronoi diagram_;
    std::vector<std::uint32_t> corners_;
};

} // namespace

DelaunayTriangulation delaunay(std::span<const glm::dvec2> points) {
    const std::vector<GridPoint> grid = on_grid(points);
    DelaunayTriangulation result;
    const std::vector<std::uint32_t> first = distinct(grid, result.place);
    result.triangles = Circles(grid, first).triangles();
    return result;
}

} // namespace vkfv::specimen
