// Meshes that are height fields are known as such, and the walk over their cells meets what their triangles are.
#include "trace/structures/mesh_lattice.hpp"
#include "traversal_rays.hpp"

#include "core/messages/error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <vector>

namespace vkfv::trace {
namespace {

using namespace test;

// Whether the cell (column, row) is split from (i+1, j) to (i, j+1).
using Falls = std::function<bool(int, int)>;

// A height field as the triangles that a file would hold: three vertices each, in random order and sense.
specimen::Mesh soup(const specimen::HeightField& field, const Falls& falls, std::uint32_t seed = 7) {
    std::mt19937 generator(seed);
    specimen::Mesh mesh;
    const auto vertex = [&](int column, int row) {
        return glm::vec3(field.x_min + column * field.pitch_x, field.y_min + row * field.pitch_y,
                         field.heights(column, row));
    };
    std::vector<std::array<glm::vec3, 3>> triangles;
    for (int row = 0; row + 1 < field.heights.rows; ++row) {
        for (int column = 0; column + 1 < field.heights.columns; ++column) {
            const glm::vec3 a = vertex(column, row), b = vertex(column + 1, row), c = vertex(column, row + 1),
                            d = vertex(column + 1, row + 1);
            if (falls(column, row)) {
                triangles.push_back({a, b, c});
                triangles.push_back({b, d, c});
            } else {
                triangles.push_back({a, b, d});
                triangles.push_back({a, d, c});
            }
        }
    }
    std::ranges::shuffle(triangles, generator);
    for (auto& triangle : triangles) {
        std::ranges::shuffle(triangle, generator);
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), triangle.begin(), triangle.end());
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

bool by_turns(int column, int row) {
    return (column * 7 + row * 3 + column * row) % 3 == 0;
}

const specimen::HeightField& waves() {
    static const specimen::HeightField field = make_field(128, 0.05 / 127, RandomWaves(0.0006, 0.006, 5));
    return field;
}

TEST(MeshLattice, IsFoundInWhatHeightMapsAreExportedAs) {
    const auto lattice = lattice_of(soup(waves(), by_turns));
    ASSERT_TRUE(lattice);
    EXPECT_EQ(lattice->field.heights.values, waves().heights.values);
    EXPECT_NEAR(lattice->field.pitch_x, waves().pitch_x, 1e-9);
    EXPECT_NEAR(lattice->field.x_min, waves().x_min, 1e-8);
    for (int row = 0; row < 127; ++row) {
        for (int column = 0; column < 127; ++column) {
            EXPECT_EQ(lattice->falling[static_cast<std::size_t>(row * 127 + column)], by_turns(column, row));
        }
    }
    // The field is wider than deep.
    specimen::HeightField strip = make_field(40, 0.001, RandomWaves(0.0006, 0.006, 6));
    strip.heights.rows = 3;
    strip.heights.values.resize(120);
    EXPECT_TRUE(lattice_of(soup(strip, by_turns)));
}

TEST(MeshLattice, IsNotFoundWhereThereIsNone) {
    const specimen::Mesh whole = soup(waves(), by_turns);
    specimen::Mesh hole = whole;
    hole.triangles.pop_back();
    EXPECT_FALSE(lattice_of(hole));
    hole.triangles.pop_back(); // an even number
    EXPECT_FALSE(lattice_of(hole));
    specimen::Mesh twice = whole;
    twice.triangles.back() = twice.triangles.front();
    EXPECT_FALSE(lattice_of(twice));
    specimen::Mesh moved = whole;
    moved.vertices[1000].x += 3e-6F;
    EXPECT_FALSE(lattice_of(moved));
    specimen::Mesh torn = whole;
    torn.vertices[1000].z += 1e-4F; // moves this point of one triangle alone
    EXPECT_FALSE(lattice_of(torn));
    specimen::Mesh turned = whole;
    for (glm::vec3& vertex : turned.vertices) {
        vertex = {0.8F * vertex.x - 0.6F * vertex.y, 0.6F * vertex.x + 0.8F * vertex.y, vertex.z};
    }
    EXPECT_FALSE(lattice_of(turned));
    specimen::Mesh upright = whole;
    for (glm::vec3& vertex : upright.vertices) {
        vertex = {vertex.x, vertex.z, vertex.y};
    }
    EXPECT_FALSE(lattice_of(upright));
    EXPECT_FALSE(lattice_of({}));
    EXPECT_FALSE(lattice_of({{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {{0, 1, 2}, {0, 1, 2}}}));
}

// Rays go down from above, and on from where they met, over the hemisphere.
TEST(MeshLattice, IsMetAsItsTriangles) {
    for (const Falls& falls :
         {Falls(by_turns), Falls([](int, int) { return true; }), Falls([](int, int) { return false; })}) {
        const specimen::Specimen surface{soup(waves(), falls), {}};
        const specimen::Intersector reference(surface);
        auto rays = rays_from_top(surface, 100'000, 0.5, 0.002, 18);
        for (std::size_t k = 0; k < rays.size(); k += 50) {
            rays[k].direction = {0, 0, -1.0F};
        }
        const auto down = meet(surface, Traversal::bvh, rays);
        const auto leaving = scattered_rays(down, 19);
        rays.insert(rays.end(), leaving.begin(), leaving.end());
        const auto expected = meet(reference, rays);
        const auto hits = meet(surface, Traversal::quadtree, rays);
        const Comparison seen = compare(reference, rays, hits, expected, nm);
        EXPECT_GT(seen.both, rays.size() / 3);
        EXPECT_EQ(seen.one_only, 0u);
        EXPECT_EQ(seen.apart, 0u);
        EXPECT_LE(static_cast<double>(seen.for_rounding), 10 * share_for_rounding * static_cast<double>(rays.size()));
        // The wrong twin has the same heights, split the other way.
        const specimen::Specimen other{soup(waves(), [&](int i, int j) { return !falls(i, j); }), {}};
        const Comparison wrong = compare(reference, rays, meet(other, Traversal::quadtree, rays), expected, nm);
        EXPECT_GT(wrong.one_only + wrong.apart, rays.size() / 20);
        // The normal is that of the triangle.
        std::size_t turned = 0;
        for (std::size_t k = 0; k < 100'000; ++k) {
            const bool both = hits[k].found == 1u && down[k].found == 1u;
            turned += both && glm::distance(hits[k].normal, down[k].normal) > 1e-3F ? 1 : 0;
        }
        EXPECT_LE(turned, 200u); // at creases
    }
}

TEST(MeshLattice, ChoosesTheQuadtreeWhereThereIsNoRayQuery) {
    vulkan::DeviceReport without;
    without.name = "a GPU";
    without.type = "discrete GPU";
    const specimen::Specimen lattice{soup(waves(), by_turns), {}};
    specimen::Mesh holed = std::get<specimen::Mesh>(lattice.geometry);
    holed.triangles.pop_back();
    const specimen::Specimen mesh{holed, {}};
    EXPECT_EQ(choose_traversal(without, lattice, Traversal::automatic).traversal, Traversal::quadtree);
    EXPECT_EQ(choose_traversal(without, lattice, Traversal::quadtree).traversal, Traversal::quadtree);
    EXPECT_EQ(choose_traversal(without, lattice, Traversal::bvh).traversal, Traversal::bvh);
    EXPECT_EQ(choose_traversal(without, lattice, Traversal::automatic, true).traversal, Traversal::bvh);
    EXPECT_EQ(choose_traversal(without, mesh, Traversal::automatic).traversal, Traversal::bvh);
    EXPECT_THROW(choose_traversal(without, mesh, Traversal::quadtree), InputError);
    without.ray_query = true;
    EXPECT_EQ(choose_traversal(without, lattice, Traversal::automatic).traversal, Traversal::ray_query);
}

} // namespace
} // namespace vkfv::trace
