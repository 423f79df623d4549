// Traversals of meshes agree with closed forms and the host's reference; the traversal chosen is known, and meshes that
// no device holds are refused.
#include "traversal_rays.hpp"

#include "core/messages/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace vkfv::trace {
namespace {

using namespace test;
using testing::HasSubstr;

// A sphere of triangles about (0, 0, 0): a regular octahedron whose edges are halved, the points moved out to
// the radius.
specimen::Mesh octahedral_sphere(double radius, int halvings) {
    std::vector<glm::dvec3> vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<glm::uvec3> triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                         {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int k = 0; k < halvings; ++k) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [at, made] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(vertices.size()));
            if (made) {
                vertices.push_back(glm::normalize(vertices[a] + vertices[b]));
            }
            return at->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& t : triangles) {
            const std::uint32_t ab = middle(t.x, t.y);
            const std::uint32_t bc = middle(t.y, t.z);
            const std::uint32_t ca = middle(t.z, t.x);
            finer.insert(finer.end(), {{t.x, ab, ca}, {ab, t.y, bc}, {ca, bc, t.z}, {ab, bc, ca}});
        }
        triangles = finer;
    }
    specimen::Mesh mesh;
    for (const glm::dvec3& vertex : vertices) {
        mesh.vertices.emplace_back(radius * vertex);
    }
    mesh.triangles = triangles;
    return mesh;
}

// The number of rays that disagree with a ball of the given radius within the facets' depth below it.
std::size_t disagreements(const std::vector<ProbeRay>& rays, const std::vector<Hit>& hits, double radius,
                          double sagitta) {
    std::size_t count = 0;
    for (std::size_t k = 0; k < rays.size(); ++k) {
        const glm::dvec3 origin(rays[k].origin);
        const glm::dvec3 direction = glm::normalize(glm::dvec3(rays[k].direction));
        const double along = -glm::dot(origin, direction);
        const double passing = glm::length(origin + along * direction); // distance of the ray from the centre
        const double r = glm::length(glm::dvec3(hits[k].position));
        const bool must_meet = passing < radius - sagitta;
        const bool may_meet = passing <= radius;
        // A facet is met between the ball and the ball that the facets enclose, and so is the distance along the ray.
        const auto entry = [&](double ball) {
            return along - std::sqrt(std::max(ball * ball - passing * passing, 0.0));
        };
        const auto distance = static_cast<double>(hits[k].distance);
        const bool right = hits[k].found == 0
                               ? !must_meet
                               : may_meet && r <= radius + rounding && r >= radius - sagitta - rounding &&
                                     distance >= entry(radius) - nm &&
                                     distance <= (must_meet ? entry(radius - sagitta) : along) + nm &&
                                     glm::dot(glm::dvec3(hits[k].normal), direction) < 0;
        count += right ? 0 : 1;
    }
    return count;
}

TEST(Traversal, AMeshIsMetLikeTheSphereItApproximates) {
    const double radius = 0.05;
    const int halvings = 6;
    const specimen::Specimen ball{octahedral_sphere(radius, halvings), {}};
    const auto& mesh = std::get<specimen::Mesh>(ball.geometry);
    // A facet lies below the sphere by at most R - sqrt(R^2 - rho^2) with rho its circumradius, at most its
    // longest edge over sqrt(2) for these triangles without obtuse angles (and over sqrt(3) for an
    // equilateral one).
    double longest = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        longest = std::max({longest, static_cast<double>(glm::distance(mesh.vertices[t.x], mesh.vertices[t.y])),
                            static_cast<double>(glm::distance(mesh.vertices[t.y], mesh.vertices[t.z])),
                            static_cast<double>(glm::distance(mesh.vertices[t.z], mesh.vertices[t.x]))});
    }
    const double sagitta = radius - std::sqrt(radius * radius - longest * longest / 2);

    std::mt19937 generator(19);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform;
    std::vector<ProbeRay> rays = rays_from_top(ball, 50'000, 0.3, 0.01, 18);
    // Further rays come from all sides: from 0.09 mm off the centre towards a point of a slightly larger ball.
    for (int k = 0; k < 50'000; ++k) {
        const glm::vec3 from = glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator)));
        const glm::vec3 to = glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator)));
        rays.push_back({0.09F * from, glm::normalize(0.055F * uniform(generator) * to - 0.09F * from)});
    }
    for (const Traversal traversal : {Traversal::ray_query, Traversal::bvh}) {
        const auto hits = meet(ball, traversal, rays);
        EXPECT_GT(std::ranges::count(hits, 1u, &Hit::found), 50'000);
        EXPECT_EQ(disagreements(rays, hits, radius, sagitta), 0u);
        // The wrong twin is a ball larger by two depths of its facets.
        EXPECT_GT(disagreements(rays, hits, radius + 2 * sagitta, sagitta), rays.size() / 2);
    }
}

// Rays go from points within, up at every vertex and every edge's middle: those that the traversals do not try again.
TEST(Traversal, AClosedMeshLetsNoRayThroughItsHierarchy) {
    specimen::Specimen ball{octahedral_sphere(0.05, 5), {}};
    auto& mesh = std::get<specimen::Mesh>(ball.geometry);
    std::vector<ProbeRay> rays;
    for (const glm::vec3& from : {glm::vec3(0), glm::vec3(0.013F, -0.007F, -0.011F), glm::vec3(0, 0.03F, -0.02F)}) {
        const auto aim = [&](const glm::vec3& target) {
            if (target.z > from.z) {
                rays.push_back({from, glm::normalize(target - from)});
            }
        };
        for (const glm::uvec3& t : mesh.triangles) {
            aim(mesh.vertices[t.x]);
            aim(0.5F * (mesh.vertices[t.x] + mesh.vertices[t.y]));
            aim(0.5F * (mesh.vertices[t.y] + mesh.vertices[t.z]));
            aim(0.5F * (mesh.vertices[t.z] + mesh.vertices[t.x]));
        }
    }
    EXPECT_EQ(std::ranges::count(meet(ball, Traversal::bvh, rays), 0u, &Hit::found), 0);
    mesh.triangles.erase(mesh.triangles.begin()); // a hole, in the octant of +x, +y, +z
    EXPECT_GT(std::ranges::count(meet(ball, Traversal::bvh, rays), 0u, &Hit::found), 0);
}

// A mesh of slivers and crossing triangles of all sizes in a cube of 0.1 mm: no grid of cells resembles it.
specimen::Mesh thicket(std::size_t count, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
    specimen::Mesh mesh;
    for (std::size_t k = 0; k < count; ++k) {
        const auto point = [&](float size) {
            return size * glm::vec3(uniform(generator), uniform(generator), uniform(generator));
        };
        const glm::vec3 corner = point(0.05F);
        const float size = 0.03F * std::pow(0.5F, 3.0F * (1 + uniform(generator)));
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), {corner, corner + point(size), corner + point(size)});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

// Rays from all sides, also from within, towards points of a ball of 0.05 mm; the longest travel 0.3 mm.
std::vector<ProbeRay> rays_from_all_sides(std::size_t count, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> uniform;
    const auto point = [&](float radius) {
        return radius * uniform(generator) *
               glm::normalize(glm::vec3(normal(generator), normal(generator), normal(generator)));
    };
    std::vector<ProbeRay> rays;
    while (rays.size() < count) {
        const glm::vec3 from = point(0.15F);
        const glm::vec3 to = point(0.05F);
        if (glm::distance(from, to) > 0.001F) {
            rays.push_back({from, glm::normalize(to - from)});
        }
    }
    return rays;
}

TEST(Traversal, AnyMeshIsMetAsOnTheHost) {
    const specimen::Specimen surface{thicket(3000, 31), {}};
    const specimen::Intersector reference(surface);
    auto rays = rays_from_all_sides(200'000, 32);
    for (std::size_t k = 0; k < rays.size(); k += 10) {
        rays[k].direction = {0, 0, rays[k].direction.z < 0 ? -1.0F : 1.0F}; // along an axis
    }
    const auto expected = meet(reference, rays);
    for (const Traversal traversal : {Traversal::ray_query, Traversal::bvh}) {
        const Comparison seen = compare(reference, rays, meet(surface, traversal, rays), expected, nm);
        EXPECT_GT(seen.both, rays.size() / 3);
        EXPECT_EQ(seen.one_only + seen.apart, 0u);
        // There are more edges to pass than on a height field.
        EXPECT_LE(static_cast<double>(seen.for_rounding), 10 * share_for_rounding * static_cast<double>(rays.size()));
    }
}

TEST(Traversal, IsChosenForDeviceAndSpecimen) {
    vulkan::DeviceReport cpu;
    cpu.name = "software";
    cpu.type = "CPU";
    cpu.ray_query = true;
    vulkan::DeviceReport rtx = cpu;
    rtx.type = "discrete GPU";
    vulkan::DeviceReport without = rtx;
    without.ray_query = false;
    const specimen::Specimen field{make_field(3, 0.001, [](double, double) { return 0.0; }), {}};
    const specimen::Specimen mesh{octahedral_sphere(0.05, 0), {}};
    const auto chosen = [](const auto& device, const auto& specimen, Traversal asked, const char* reason) {
        const ChosenTraversal choice = choose_traversal(device, specimen, asked);
        EXPECT_THAT(choice.reason, HasSubstr(reason));
        return choice.traversal;
    };
    EXPECT_EQ(chosen(cpu, field, Traversal::automatic, "CPU"), Traversal::quadtree);
    EXPECT_EQ(chosen(rtx, field, Traversal::automatic, ""), Traversal::ray_query);
    EXPECT_EQ(chosen(without, field, Traversal::automatic, "no ray query"), Traversal::quadtree);
    EXPECT_EQ(chosen(cpu, field, Traversal::ray_query, ""), Traversal::ray_query);
    EXPECT_EQ(chosen(rtx, field, Traversal::quadtree, "asked"), Traversal::quadtree);
    EXPECT_EQ(chosen(rtx, field, Traversal::bvh, "bvh (as asked"), Traversal::bvh);
    EXPECT_EQ(chosen(rtx, mesh, Traversal::automatic, ""), Traversal::ray_query);
    EXPECT_EQ(chosen(cpu, mesh, Traversal::automatic, "CPU"), Traversal::bvh);
    EXPECT_EQ(chosen(without, mesh, Traversal::automatic, "no ray query"), Traversal::bvh);
    EXPECT_THROW(choose_traversal(rtx, mesh, Traversal::quadtree), InputError);
    EXPECT_THROW(choose_traversal(without, mesh, Traversal::ray_query), DeviceError);
    EXPECT_THROW(choose_traversal(without, field, Traversal::ray_query), DeviceError);
}

TEST(Traversal, ASpecimenTooLargeForTheDeviceIsRefusedWithSizes) {
    const std::uint64_t limit = device().report().max_storage_buffer_bytes;
    int side = 512; // 8 bytes a point
    while (std::uint64_t{8} * static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side) <= limit) {
        side += 512;
    }
    ASSERT_LT(side, 20'000) << "this device takes more than the test can make";
    specimen::HeightField field;
    field.heights = Grid<float>(side, side);
    field.pitch_x = field.pitch_y = 0.001;
    try {
        const DeviceSpecimen refused(device(), {field, {}}, Traversal::quadtree);
        FAIL() << "taken";
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr(std::to_string(limit)));
        EXPECT_THAT(error.what(), HasSubstr("larger pitch"));
    }
}

} // namespace
} // namespace vkfv::trace
