#include "trace/structures/triangle_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <vector>

namespace vkfv::trace {
namespace {

// The corners of a triangle in some fixed order, so that triangles compare however they go round.
using Corners = std::array<std::array<float, 3>, 3>;

Corners sorted(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Corners corners = {{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}};
    std::ranges::sort(corners);
    return corners;
}

struct Mesh {
    std::vector<glm::vec3> vertices;
    std::vector<glm::uvec3> triangles;

    std::multiset<Corners> all() const {
        std::multiset<Corners> result;
        for (const glm::uvec3& t : triangles) {
            result.insert(sorted(vertices[t.x], vertices[t.y], vertices[t.z]));
        }
        return result;
    }
};

std::multiset<Corners> all(const std::vector<TrianglePair>& pairs) {
    std::multiset<Corners> result;
    for (const auto& [c] : pairs) {
        result.insert(sorted(c[0], c[1], c[2]));
        if (c[3] != c[0]) {
            result.insert(sorted(c[0], c[2], c[3]));
        }
    }
    return result;
}

Mesh grid(std::uint32_t side) {
    Mesh mesh;
    for (std::uint32_t j = 0; j <= side; ++j) {
        for (std::uint32_t i = 0; i <= side; ++i) {
            mesh.vertices.emplace_back(static_cast<float>(i), static_cast<float>(j), static_cast<float>(i * j % 3));
        }
    }
    for (std::uint32_t j = 0; j < side; ++j) {
        for (std::uint32_t i = 0; i < side; ++i) {
            const std::uint32_t a = j * (side + 1) + i;
            const std::uint32_t b = a + side + 1;
            mesh.triangles.emplace_back(a, a + 1, b + 1);
            mesh.triangles.emplace_back(a, b + 1, b);
        }
    }
    return mesh;
}

TEST(TrianglePairs, HoldEveryTriangleOnce) {
    Mesh mesh = grid(20);
    EXPECT_EQ(pair_triangles(mesh.vertices, mesh.triangles).size(), 400u);
    std::mt19937 generator(51);
    std::ranges::shuffle(mesh.triangles, generator);
    for (glm::uvec3& t : mesh.triangles) {
        t = generator() % 2 == 0 ? glm::uvec3(t.y, t.z, t.x) : glm::uvec3(t.x, t.z, t.y); // any way round
    }
    const auto pairs = pair_triangles(mesh.vertices, mesh.triangles);
    EXPECT_EQ(all(pairs), mesh.all());
    // Some triangles are left over, whose neighbours all went to others: 40 % more than half as many pairs at most.
    EXPECT_LT(pairs.size(), 560u);
    mesh.triangles.pop_back();
    EXPECT_NE(all(pairs), mesh.all());
}

// Large meshes are paired in parts, over whose borders few triangles would have found a partner.
TEST(TrianglePairs, HoldEveryTriangleOfManyOnce) {
    const Mesh mesh = grid(300);
    const auto pairs = pair_triangles(mesh.vertices, mesh.triangles);
    EXPECT_EQ(all(pairs), mesh.all());
    EXPECT_LE(pairs.size(), 90'000u + 4);
}

TEST(TrianglePairs, TakeThePartnerThatMakesTheSmallestBox) {
    // Two triangles stand at the middle one's sides, the second far away.
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {9, 9, 9}, {1, 1, 0}}, {{0, 1, 2}, {0, 1, 3}, {1, 2, 4}}};
    const auto pairs = pair_triangles(mesh.vertices, mesh.triangles);
    ASSERT_EQ(pairs.size(), 2u);
    EXPECT_EQ(pairs[0].box().maximum, glm::vec3(1, 1, 0));
    EXPECT_EQ(pairs[0].box().minimum, glm::vec3(0));
    EXPECT_EQ(all(pairs), mesh.all());
}

TEST(TrianglePairs, TakeWhatIsNoSurface) {
    // A triangle may come twice, and three may share an edge; triangles without extent must not disturb the others.
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 1}, {7, 7, 7}},
              {{0, 1, 2}, {0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
    EXPECT_EQ(all(pair_triangles(mesh.vertices, mesh.triangles)), mesh.all());
    const auto proper = mesh.all();
    mesh.triangles.insert(mesh.triangles.begin(), {{5, 5, 5}, {2, 2, 3}, {0, 1, 0}});
    const auto paired = all(pair_triangles(mesh.vertices, mesh.triangles));
    EXPECT_TRUE(std::ranges::includes(paired, proper));
}

} // namespace
} // namespace vkfv::trace
