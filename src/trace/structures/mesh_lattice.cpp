#include "trace/structures/mesh_lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace vkfv::trace {

namespace {

// A regular sequence of coordinates.
struct Axis {
    double first = 0; // mm
    double pitch = 0;
    int points = 0;

    // Index of the point next to a coordinate; -1: none is within the tolerance.
    int at(double coordinate) const {
        const double place = (coordinate - first) / pitch;
        const double next = std::round(place);
        return std::abs(place - next) * pitch <= lattice_tolerance && next >= 0 && next < points
                   ? static_cast<int>(next)
                   : -1;
    }
};

// The axis from the first to the last coordinate in steps of about `pitch`; none if there is no such axis.
std::optional<Axis> axis_of(double first, double last, double pitch) {
    const double steps = std::round((last - first) / pitch);
    if (!(pitch > 2 * lattice_tolerance) || steps < 1 || steps > 1e6) {
        return {};
    }
    return Axis{first, (last - first) / steps, static_cast<int>(steps) + 1};
}

constexpr float no_height = std::numeric_limits<float>::quiet_NaN();

} // namespace

std::optional<MeshLattice> lattice_of(const specimen::Mesh& mesh) {
    if (mesh.vertices.empty() || mesh.triangles.empty()) {
        return {};
    }
    glm::vec3 lowest = mesh.vertices.front(), highest = lowest;
    for (const glm::vec3& vertex : mesh.vertices) {
        lowest = glm::min(lowest, vertex);
        highest = glm::max(highest, vertex);
    }
    // Any triangle is as wide and as deep as a cell, so the first gives the pitches.
    const glm::uvec3 any = mesh.triangles.front();
    const glm::vec3 a = mesh.vertices[any.x], b = mesh.vertices[any.y], c = mesh.vertices[any.z];
    const glm::vec3 extent = glm::max(a, glm::max(b, c)) - glm::min(a, glm::min(b, c));
    const auto x_axis = axis_of(lowest.x, highest.x, extent.x);
    const auto y_axis = axis_of(lowest.y, highest.y, extent.y);
    if (!x_axis || !y_axis) {
        return {};
    }
    const std::size_t cells_x = static_cast<std::size_t>(x_axis->points) - 1;
    const std::size_t cells_y = static_cast<std::size_t>(y_axis->points) - 1;
    if (2 * cells_x * cells_y != mesh.triangles.size()) {
        return {};
    }
    MeshLattice lattice;
    lattice.field.heights = Grid<float>(x_axis->points, y_axis->points);
    std::ranges::fill(lattice.field.heights.values, no_height);
    lattice.field.x_min = x_axis->first;
    lattice.field.y_min = y_axis->first;
    lattice.field.pitch_x = x_axis->pitch;
    lattice.field.pitch_y = y_axis->pitch;
    std::vector<glm::ivec2> places;
    places.reserve(mesh.vertices.size());
    for (const glm::vec3& vertex : mesh.vertices) {
        const glm::ivec2 place(x_axis->at(vertex.x), y_axis->at(vertex.y));
        if (place.x < 0 || place.y < 0) {
            return {};
        }
        float& height = lattice.field.heights(place.x, place.y);
        if (!std::isnan(height) && height != vertex.z) {
            return {}; // there is a wall or a second surface
        }
        height = vertex.z;
        places.push_back(place);
    }
    // The triangles that each cell has: bit k for the one that lacks corner k of (0, 0), (1, 0), (0, 1) and (1, 1).
    std::vector<std::uint8_t> covered(cells_x * cells_y);
    for (const glm::uvec3& triangle : mesh.triangles) {
        const std::array<glm::ivec2, 3> corners = {places[triangle.x], places[triangle.y], places[triangle.z]};
        const glm::ivec2 least = glm::min(corners[0], glm::min(corners[1], corners[2]));
        unsigned present = 0;
        for (const glm::ivec2& corner : corners) {
            const glm::ivec2 step = corner - least;
            if (step.x > 1 || step.y > 1) {
                return {};
            }
            present |= 1U << (step.x + 2 * step.y);
        }
        unsigned lacking = 0;
        while (lacking < 4 && present != (15U & ~(1U << lacking))) {
            ++lacking;
        }
        if (lacking == 4) {
            return {}; // the triangle's corners are not three of one cell
        }
        covered[static_cast<std::size_t>(least.y) * cells_x + static_cast<std::size_t>(least.x)] |=
            static_cast<std::uint8_t>(1U << lacking);
    }
    lattice.falling.reserve(covered.size());
    for (const std::uint8_t triangles : covered) {
        const bool rising =
            triangles == 0b0110; // the triangles without (1, 0) and (0, 1) share the diagonal from (0, 0) to (1, 1)
        const bool falling = triangles == 0b1001;
        if (!rising && !falling) {
            return {};
        }
        lattice.falling.push_back(falling);
    }
    return lattice;
}

} // namespace vkfv::trace
