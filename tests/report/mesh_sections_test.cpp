// The plane of drawing cuts a mesh in lines that closed forms know.
#include "report/mesh_sections.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vkfv::report {
namespace {

// A cube with corners at +-1; bit k of a corner's number is set if the corner lies at + along axis k.
optics::Facets unit_cube() {
    optics::Facets cube;
    for (int corner = 0; corner < 8; ++corner) {
        cube.vertices.emplace_back((corner & 1) * 2 - 1, (corner >> 1 & 1) * 2 - 1, (corner >> 2) * 2 - 1);
    }
    constexpr int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (const auto& face : faces) {
        cube.triangles.emplace_back(face[0], face[1], face[2]);
        cube.triangles.emplace_back(face[0], face[2], face[3]);
    }
    return cube;
}

double area_of(const SectionLine& line) {
    double twice = 0;
    for (std::size_t k = 0; k < line.points.size(); ++k) {
        const glm::dvec2 a = line.points[k], b = line.points[(k + 1) % line.points.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return std::abs(twice) / 2;
}

TEST(MeshSections, ACubeIsCutAsASquare) {
    const auto lines = section_of(unit_cube());
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_TRUE(lines[0].closed);
    EXPECT_NEAR(area_of(lines[0]), 4, 1e-12);
    for (const glm::dvec2& point : lines[0].points) {
        EXPECT_NEAR(std::max(std::abs(point.x), std::abs(point.y)), 1, 1e-12);
    }
}

TEST(MeshSections, AnOpenMeshIsCutAsALineWithEnds) {
    auto open = unit_cube();
    open.triangles.erase(open.triangles.begin() + 2, open.triangles.begin() + 4); // without its face at +z
    const auto lines = section_of(open);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_FALSE(lines[0].closed);
    EXPECT_NEAR(lines[0].points.front().y, 1, 1e-12);
    EXPECT_NEAR(lines[0].points.back().y, 1, 1e-12);
}

// The time does not go with the square of the number of bodies: that would be minutes.
TEST(MeshSections, ManyBodiesAreManyLines) {
    optics::Facets bodies;
    constexpr std::uint32_t count = 20000;
    const auto cube = unit_cube();
    for (std::uint32_t body = 0; body < count; ++body) {
        for (const glm::dvec3& vertex : cube.vertices) {
            bodies.vertices.push_back(vertex + glm::dvec3(0, 3.0 * body, 0));
        }
        for (const glm::uvec3& triangle : cube.triangles) {
            bodies.triangles.push_back(triangle + 8 * body);
        }
    }
    const auto lines = section_of(bodies);
    ASSERT_EQ(lines.size(), count);
    EXPECT_TRUE(std::ranges::all_of(lines, &SectionLine::closed));
}

TEST(MeshSections, WhatThePlaneDoesNotMeetIsNotCut) {
    auto aside = unit_cube();
    for (glm::dvec3& vertex : aside.vertices) {
        vertex.x += 3;
    }
    EXPECT_TRUE(section_of(aside).empty());
}

} // namespace
} // namespace vkfv::report
