#include "report/mesh_sections.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace vkfv::report {

namespace {

using MeshEdge = std::pair<std::uint32_t, std::uint32_t>;

// Pieces of section lines. The section of a facet is a piece of a line between two of its edges; each edge ends at most
// two pieces.
using Pieces = std::multimap<MeshEdge, MeshEdge>;

Pieces pieces_of(const optics::Facets& facets) {
    Pieces pieces;
    for (const glm::uvec3& triangle : facets.triangles) {
        std::vector<MeshEdge> crossed;
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t a = triangle[corner], b = triangle[(corner + 1) % 3];
            if ((facets.vertices[a].x >= 0) != (facets.vertices[b].x >= 0)) {
                crossed.push_back(std::minmax(a, b));
            }
        }
        if (crossed.size() == 2) {
            pieces.emplace(crossed[0], crossed[1]);
            pieces.emplace(crossed[1], crossed[0]);
        }
    }
    return pieces;
}

glm::dvec2 crossing(const optics::Facets& facets, const MeshEdge& edge) {
    const glm::dvec3 &a = facets.vertices[edge.first], &b = facets.vertices[edge.second];
    const glm::dvec3 point = a + (b - a) * (a.x / (a.x - b.x));
    return {point.y, point.z};
}

// Removes a piece that begins at the edge, in both directions; returns its other end.
std::optional<MeshEdge> step(Pieces& pieces, const MeshEdge& from) {
    const auto piece = pieces.find(from);
    if (piece == pieces.end()) {
        return std::nullopt;
    }
    const MeshEdge to = piece->second;
    pieces.erase(piece);
    const auto [first, end] = pieces.equal_range(to);
    pieces.erase(std::find(first, end, Pieces::value_type(to, from)));
    return to;
}

// The line that begins at this edge; its pieces are removed.
SectionLine line_from(Pieces& pieces, const MeshEdge& start, const optics::Facets& facets) {
    SectionLine line;
    line.points.push_back(crossing(facets, start));
    for (auto edge = step(pieces, start); edge; edge = step(pieces, *edge)) {
        line.closed = *edge == start;
        if (!line.closed) {
            line.points.push_back(crossing(facets, *edge));
        }
    }
    return line;
}

} // namespace

std::vector<SectionLine> section_of(const optics::Facets& facets) {
    Pieces pieces = pieces_of(facets);
    std::vector<MeshEdge> ends; // ends of lines that are not closed
    for (const auto& [edge, other] : pieces) {
        if (pieces.count(edge) == 1) {
            ends.push_back(edge);
        }
    }
    std::vector<SectionLine> lines;
    for (const MeshEdge& end : ends) {
        if (pieces.contains(end)) { // otherwise the end belongs to an earlier line
            lines.push_back(line_from(pieces, end, facets));
        }
    }
    while (!pieces.empty()) {
        const MeshEdge start = pieces.begin()->first;
        lines.push_back(line_from(pieces, start, facets));
    }
    return lines;
}

} // namespace vkfv::report
