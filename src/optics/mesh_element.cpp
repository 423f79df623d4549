#include "optics/mesh_element.hpp"

#include <algorithm>
#include <bit>
#include <map>
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

// From the lower index to the higher, and which way a facet goes along it.
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

// Calls use(first, end) for the edges between each two vertices.
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

} // namespace

Facets welded(const std::vector<glm::dvec3>& vertices, const std::vector<glm::uvec3>& triangles) {
    Facets result;
    std::unordered_map<glm::dvec3, std::uint32_t, PlaceHash> indices;
    std::vector<std::uint32_t> place;
    place.reserve(vertices.size());
    for (const glm::dvec3& vertex : vertices) {
        const glm::dvec3 key = vertex + 0.0; // -0 and 0 are one
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
    double six_volumes = 0;
    const glm::dvec3 middle = facets.vertices.front(); // near, or differences would round
    for (const glm::uvec3& t : facets.triangles) {
        six_volumes += glm::dot(facets.vertices[t.x] - middle,
                                glm::cross(facets.vertices[t.y] - middle, facets.vertices[t.z] - middle));
    }
    if (six_volumes < 0) {
        for (glm::uvec3& triangle : facets.triangles) {
            std::swap(triangle.y, triangle.z);
        }
    }
    return facets;
}

std::vector<glm::dvec3> normals_of(const Facets& facets) {
    constexpr double thinnest = 1e-6; // beside its length: single precision gives its corners
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
    // That of the facet across the longest edge, unless that is a sliver too.
    const std::vector<Edge> edges = sorted_edges(facets.triangles);
    std::map<std::uint32_t, std::pair<double, std::uint32_t>> neighbours; // of a sliver: the edge's length, the facet
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
