#include "optics/train/mesh_element.hpp"

#include "core/mathematics/box_tree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace vkfv::optics {

namespace {

struct PlaceHash {
    std::size_t operator()(const glm::dvec3& place) const {
        std::uint64_t hash = 0;
        for (int axis = 0; axis < 3; ++axis) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(place[axis])) * 0x9E3779B97F4A7C15u; // 2^64 / golden ratio
            hash ^= hash >> 32;
        }
        return hash;
    }
};

// An edge from the lower vertex index to the higher, and the direction in which a facet runs along it.
struct Edge {
    std::uint32_t low, high;
    bool forward;
    std::uint32_t facet;
};

std::vector<Edge> sorted_edges(const std::vector<glm::uvec3>& triangles) {
    std::vector<Edge> edges;
    edges.reserve(3 * triangles.size());
    for (std::uint32_t facet = 0; facet < triangles.size(); ++facet) {
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t from = triangles[facet][corner], to = triangles[facet][(corner + 1) % 3];
            edges.push_back({std::min(from, to), std::max(from, to), from < to, facet});
        }
    }
    std::ranges::stable_sort(
        edges, [](const Edge& a, const Edge& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
    return edges;
}

// Calls use(first, end) with the range of edges that join the same two vertices.
template <class Use>
void for_each_edge(const std::vector<Edge>& edges, Use use) {
    for (std::size_t first = 0; first < edges.size();) {
        std::size_t end = first + 1;
        while (end < edges.size() && edges[end].low == edges[first].low && edges[end].high == edges[first].high) {
            ++end;
        }
        use(first, end);
        first = end;
    }
}

// A set of facets connected by edges.
struct Shell {
    std::vector<std::uint32_t> facets;
    double six_volumes = 0; // six times the volume, positive if the facets run counter-clockwise seen from outside
    BoxTree::Box box{glm::dvec3(HUGE_VAL), glm::dvec3(-HUGE_VAL)};
};

std::vector<Shell> shells_of(const Facets& facets) {
    std::vector<std::uint32_t> of(facets.triangles.size()); // union-find parents: a facet of the same shell, or itself
    std::iota(of.begin(), of.end(), 0u);
    const auto root = [&](std::uint32_t facet) {
        while (of[facet] != facet) {
            facet = of[facet] = of[of[facet]];
        }
        return facet;
    };
    const std::vector<Edge> edges = sorted_edges(facets.triangles);
    for_each_edge(edges, [&](std::size_t first, std::size_t end) {
        for (std::size_t other = first + 1; other < end; ++other) {
            const std::uint32_t a = root(edges[first].facet), b = root(edges[other].facet);
            of[std::max(a, b)] = std::min(a, b);
        }
    });
    std::vector<Shell> shells;
    std::vector<std::size_t> number(of.size());
    for (std::uint32_t facet = 0; facet < of.size(); ++facet) {
        if (of[facet] == facet) { // the root, which is the first facet of its shell
            number[facet] = shells.size();
            shells.emplace_back();
        }
        Shell& shell = shells[number[root(facet)]];
        shell.facets.push_back(facet);
        const glm::uvec3& t = facets.triangles[facet];
        // The origin is near, because a far one would lose digits.
        const glm::dvec3 middle = facets.vertices[facets.triangles[shell.facets.front()].x];
        const glm::dvec3 a = facets.vertices[t.x], b = facets.vertices[t.y], c = facets.vertices[t.z];
        shell.six_volumes += glm::dot(a - middle, glm::cross(b - middle, c - middle));
        shell.box = {glm::min(shell.box.lower, glm::min(a, glm::min(b, c))),
                     glm::max(shell.box.upper, glm::max(a, glm::max(b, c)))};
    }
    return shells;
}

const glm::dvec3 any_direction = glm::normalize(glm::dvec3(0.4371, 0.7713, 0.4627)); // parallel to no usual edge

// The number of crossings of a shell by the ray from a point in any_direction (Moeller and Trumbore, "Fast, minimum
// storage ray-triangle intersection", 1997).
int crossings_of(const Facets& facets, const Shell& shell, const glm::dvec3& from) {
    int crossings = 0;
    for (const std::uint32_t facet : shell.facets) {
        const glm::uvec3& t = facets.triangles[facet];
        const glm::dvec3 a = facets.vertices[t.x], ab = facets.vertices[t.y] - a, ac = facets.vertices[t.z] - a;
        const glm::dvec3 p = glm::cross(any_direction, ac), q = glm::cross(from - a, ab);
        const double determinant = glm::dot(ab, p);
        const double u = glm::dot(from - a, p) / determinant, v = glm::dot(any_direction, q) / determinant;
        const bool meets = determinant != 0 && u >= 0 && v >= 0 && u + v <= 1;
        crossings += meets && glm::dot(ac, q) / determinant > 0 ? 1 : 0;
    }
    return crossings;
}

} // namespace

Facets welded(const std::vector<glm::dvec3>& vertices, const std::vector<glm::uvec3>& triangles) {
    Facets result;
    std::unordered_map<glm::dvec3, std::uint32_t, PlaceHash> indices;
    std::vector<std::uint32_t> place;
    place.reserve(vertices.size());
    for (const glm::dvec3& vertex : vertices) {
        const glm::dvec3 key = vertex + 0.0; // + 0.0 makes -0 equal to 0
        const auto [entry, is_new] = indices.try_emplace(key, static_cast<std::uint32_t>(result.vertices.size()));
        if (is_new) {
            result.vertices.push_back(key);
        }
        place.push_back(entry->second);
    }
    for (const glm::uvec3& triangle : triangles) {
        const glm::uvec3 corners(place[triangle.x], place[triangle.y], place[triangle.z]);
        if (corners.x != corners.y && corners.y != corners.z && corners.z != corners.x) {
            result.triangles.push_back(corners);
        }
    }
    return result;
}

Openness openness_of(const Facets& facets) {
    Openness openness;
    const std::vector<Edge> edges = sorted_edges(facets.triangles);
    for_each_edge(edges, [&](std::size_t first, std::size_t end) {
        const bool open = end - first == 1;
        const bool sound = end - first == 2 && edges[first].forward != edges[first + 1].forward;
        if (!sound && openness.closed()) {
            openness.first = facets.vertices[edges[first].low];
        }
        openness.open_edges += open ? 1 : 0;
        openness.turned_edges += !open && !sound ? 1 : 0;
    });
    return openness;
}

Facets turned_outward(Facets facets) {
    const std::vector<Shell> shells = shells_of(facets);
    std::vector<BoxTree::Box> boxes;
    for (const Shell& shell : shells) {
        boxes.push_back(shell.box);
    }
    const BoxTree tree(boxes);
    std::vector<bool> turns;
    for (std::uint32_t one = 0; one < shells.size(); ++one) {
        // A shell within an odd number of others is the wall of a hole.
        const glm::dvec3 inside = facets.vertices[facets.triangles[shells[one].facets.front()].x];
        int crossings = 0;
        tree.walk(inside, any_direction, HUGE_VAL, [&](std::uint32_t other, double farthest) {
            crossings += other == one ? 0 : crossings_of(facets, shells[other], inside);
            return farthest;
        });
        const bool is_hole = crossings % 2 == 1;
        turns.push_back(is_hole ? shells[one].six_volumes > 0 : shells[one].six_volumes < 0);
    }
    for (std::uint32_t one = 0; one < shells.size(); ++one) {
        for (const std::uint32_t facet : shells[one].facets) {
            if (turns[one]) {
                std::swap(facets.triangles[facet].y, facets.triangles[facet].z);
            }
        }
    }
    return facets;
}

std::vector<glm::dvec3> normals_of(const Facets& facets) {
    constexpr double thinnest = 1e-6; // ratio of area to squared length: corners are in single precision
    std::vector<glm::dvec3> normals;
    normals.reserve(facets.triangles.size());
    std::vector<std::uint32_t> slivers;
    for (const glm::uvec3& t : facets.triangles) {
        const glm::dvec3 ab = facets.vertices[t.y] - facets.vertices[t.x],
                         ac = facets.vertices[t.z] - facets.vertices[t.x], bc = ac - ab;
        const glm::dvec3 cross = glm::cross(ab, ac);
        const double area = glm::length(cross);
        if (area <= thinnest * std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)})) {
            slivers.push_back(static_cast<std::uint32_t>(normals.size()));
        }
        normals.push_back(area > 0 ? cross / area : glm::dvec3(0, 0, 1));
    }
    if (slivers.empty()) {
        return normals;
    }
    // A sliver takes the normal of the facet across its longest edge, unless that is a sliver too.
    const std::vector<Edge> edges = sorted_edges(facets.triangles);
    std::map<std::uint32_t, std::pair<double, std::uint32_t>> neighbours; // by sliver: edge length and facet
    for_each_edge(edges, [&](std::size_t first, std::size_t end) {
        const double length = glm::distance(facets.vertices[edges[first].low], facets.vertices[edges[first].high]);
        for (std::size_t one = first; one < end; ++one) {
            for (std::size_t other = first; other < end; ++other) {
                const std::uint32_t sliver = edges[one].facet, facet = edges[other].facet;
                if (std::ranges::binary_search(slivers, sliver) && !std::ranges::binary_search(slivers, facet)) {
                    auto& neighbour = neighbours[sliver];
                    neighbour = std::max(neighbour, std::pair(length, facet));
                }
            }
        }
    });
    for (const auto& [sliver, neighbour] : neighbours) {
        normals[sliver] = normals[neighbour.second];
    }
    return normals;
}

} // namespace vkfv::optics
