// The traversals agree with each other and with the host's reference in double, on height fields.
#include "traversal_rays.hpp"

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

TEST(Traversal, AllAgreeOnARoughSurface) {
    const specimen::Intersector reference(rough());
    const auto rays = rays_from_top(rough(), 1'000'000, 0.4, 0.002, 1);
    const auto quadtree = meet(rough(), Traversal::quadtree, rays);
    const auto ray_query = meet(rough(), Traversal::ray_query, rays);
    const auto bvh = meet(rough(), Traversal::bvh, rays);
    for (const auto& [name, seen] :
         {std::pair("quadtree, ray query", compare(reference, rays, quadtree, ray_query, nm)),
          std::pair("quadtree, bvh", compare(reference, rays, quadtree, bvh, nm)),
          std::pair("ray query, bvh", compare(reference, rays, ray_query, bvh, nm))}) {
        SCOPED_TRACE(name);
        EXPECT_GT(seen.both, rays.size() * 9 / 10);
        EXPECT_EQ(seen.one_only, 0u);
        EXPECT_EQ(seen.apart, 0u);
        EXPECT_LE(static_cast<double>(seen.for_rounding), share_for_rounding * static_cast<double>(rays.size()));
        // The distance is as much longer than the height as the steepest slope against the flattest ray makes it.
        EXPECT_LT(seen.largest_distance, 4 * nm);
        // Within two roundings of the edges, 3.4 pitches of which belong to each cell, either facet is right.
        EXPECT_LT(static_cast<double>(seen.turned),
                  3.4 * 4 * rounding / (0.2 / 511) * static_cast<double>(rays.size()));
        RecordProperty(std::string(name) + " for_rounding", std::to_string(seen.for_rounding));
        RecordProperty(std::string(name) + " largest_height_nm", std::to_string(seen.largest_height / nm));
        RecordProperty(std::string(name) + " largest_distance_nm", std::to_string(seen.largest_distance / nm));
    }
}

TEST(Traversal, AShiftOfThreeNanometresIsRejected) {
    const specimen::Intersector reference(rough());
    const auto rays = rays_from_top(rough(), 2'000, 0.4, 0, 2);
    const auto quadtree = meet(rough(), Traversal::quadtree, rays);
    for (const Traversal traversal : {Traversal::ray_query, Traversal::bvh}) {
        const auto moved = meet(shifted(rough(), 3 * nm), traversal, rays);
        EXPECT_GT(compare(reference, rays, quadtree, moved, nm).apart, rays.size() * 9 / 10);
    }
}

TEST(Traversal, EachAgreesWithTheHostsReferenceInDouble) {
    const specimen::Intersector reference(rough());
    const auto rays = rays_from_top(rough(), 100'000, 0.4, 0.002, 3);
    const auto expected = meet(reference, rays);
    for (const Traversal traversal : every_traversal) {
        const Comparison seen = compare(reference, rays, meet(rough(), traversal, rays), expected, nm);
        EXPECT_GT(seen.both, rays.size() * 9 / 10);
        EXPECT_EQ(seen.one_only + seen.apart, 0u);
        EXPECT_LE(static_cast<double>(seen.for_rounding), share_for_rounding * static_cast<double>(rays.size()));
    }
    const auto wrong = meet(shifted(rough(), 3 * nm), Traversal::quadtree, rays);
    EXPECT_GT(compare(reference, {rays.begin(), rays.begin() + 1000}, wrong, expected, nm).apart, 900u);
}

TEST(Traversal, ScatteredLightIsMetAlike) {
    const specimen::Intersector reference(rough());
    const auto down = rays_from_top(rough(), 100'000, 0.4, 0, 4);
    const auto rays = scattered_rays(meet(rough(), Traversal::quadtree, down), 4);
    const auto quadtree = meet(rough(), Traversal::quadtree, rays);
    const auto ray_query = meet(rough(), Traversal::ray_query, rays);
    const auto bvh = meet(rough(), Traversal::bvh, rays);
    const auto expected = meet(reference, rays);
    // Few rays leave so flat that they meet the surface again; but some must, or nothing is tested.
    EXPECT_GT(compare(reference, rays, quadtree, ray_query, nm).both, rays.size() / 100);
    for (const Comparison& seen :
         {compare(reference, rays, quadtree, ray_query, nm), compare(reference, rays, quadtree, expected, nm),
          compare(reference, rays, ray_query, expected, nm), compare(reference, rays, bvh, expected, nm),
          compare(reference, rays, bvh, quadtree, nm), compare(reference, rays, bvh, ray_query, nm)}) {
        EXPECT_EQ(seen.one_only, 0u);
        EXPECT_EQ(seen.apart, 0u);
        EXPECT_LE(static_cast<double>(seen.for_rounding), 10 * share_for_rounding * static_cast<double>(rays.size()));
    }
}

TEST(Traversal, LightFromTheSideIsMetAlike) {
    // Rays go low over the surface, and start beside it between its lowest and highest point: above it or below.
    const specimen::Intersector reference(rough());
    const auto record = specimen::record(rough(), 1);
    std::mt19937 generator(6);
    std::uniform_real_distribution<double> uniform;
    std::vector<ProbeRay> rays;
    for (int k = 0; k < 30'000; ++k) {
        const double angle = two_pi * uniform(generator);
        const glm::dvec2 across(std::cos(angle), std::sin(angle));
        const double z = record.bottom + uniform(generator) * (record.top - record.bottom);
        // A ray goes towards a place over the footprint, within 6 degrees of the plane, from further away than it is
        // wide.
        const glm::dvec2 target(0.1 * (2 * uniform(generator) - 1), 0.1 * (2 * uniform(generator) - 1));
        const double rise = 0.1 * (2 * uniform(generator) - 1);
        rays.push_back({glm::vec3(target - 0.3 * across, z - 0.25 * rise), glm::normalize(glm::vec3(across, rise))});
    }
    const auto expected = meet(reference, rays);
    // A step of a float is 0.03 nm at 0.3 mm, and rays that are flatter than the surface draw it out.
    for (const Traversal traversal : every_traversal) {
        const Comparison seen = compare(reference, rays, meet(rough(), traversal, rays), expected, 4 * nm);
        EXPECT_GT(seen.both, rays.size() / 2);
        EXPECT_EQ(seen.one_only + seen.apart, 0u);
        EXPECT_LE(static_cast<double>(seen.for_rounding), 10 * share_for_rounding * static_cast<double>(rays.size()));
    }
    const auto wrong = meet(shifted(rough(), 10 * nm), Traversal::quadtree, rays);
    EXPECT_GT(compare(reference, {rays.begin(), rays.begin() + 1000}, wrong, expected, 4 * nm).apart, 100u);
}

TEST(Traversal, SteepLightLeavesTheSurface) {
    // Rays are steeper than any slope of the surface: nothing may be in the way, least of all the facet from which they
    // start.
    const auto down = rays_from_top(rough(), 100'000, 0.4, 0, 5);
    std::vector<ProbeRay> rays;
    for (const Hit& hit : meet(rough(), Traversal::quadtree, down)) {
        if (hit.found == 1) {
            rays.push_back({physics::f32::scatter_origin(hit), glm::vec3(0.0F, 0.28F, 0.96F)});
        }
    }
    for (const Traversal traversal : every_traversal) {
        const auto hits = meet(rough(), traversal, rays);
        EXPECT_EQ(std::ranges::count(hits, 1u, &Hit::found), 0);
    }
}

TEST(Traversal, NoRayAtAVertexOrAnEdgeIsLost) {
    // Rays go down at every vertex, at the middle of edges and along rows, columns and diagonals; on a flat specimen,
    // whose top plane is the surface itself, too.
    const specimen::Specimen flat{make_field(129, 0.001, [](double, double) { return 0.0; }), {}};
    const specimen::Specimen hills{make_field(129, 0.001, RandomWaves(0.0005, 0.01, 7)), {}};
    const glm::vec3 directions[] = {{0, 0, -1},          {0.6F, 0, -0.8F},
                                    {0, -0.6F, -0.8F},   {0.48F, 0.48F, -0.73430239F},
                                    {-0.28F, 0, -0.96F}, {0, 0.28F, -0.96F}};
    for (const specimen::Specimen& surface : {flat, hills}) {
        const auto& field = std::get<specimen::HeightField>(surface.geometry);
        const auto top = static_cast<float>(specimen::record(surface, 1).top);
        std::vector<ProbeRay> rays;
        for (const glm::vec3& direction : directions) {
            for (int row = 10; row < 2 * 129 - 20; ++row) {
                for (int column = 10; column < 2 * 129 - 20; ++column) {
                    const glm::vec3 target(field.x_min + 0.5 * column * field.pitch_x,
                                           field.y_min + 0.5 * row * field.pitch_y, field.heights(column / 2, row / 2));
                    rays.push_back({target + direction * ((top - target.z) / direction.z), direction});
                    rays.back().origin.z = top;
                }
            }
        }
        for (const Traversal traversal : every_traversal) {
            const auto hits = meet(surface, traversal, rays);
            EXPECT_EQ(std::ranges::count(hits, 0u, &Hit::found), 0);
            EXPECT_TRUE(std::ranges::all_of(hits, [](const Hit& hit) { return hit.normal.z > 0; }));
        }
    }
}

TEST(Traversal, ARayFromAfarIsMetAsOnTheHost) {
    // Rays go at vertices and middles of edges around the centre, from 10 mm away.
    const specimen::Specimen hills{make_field(129, 0.001, RandomWaves(0.0005, 0.01, 7)), {}};
    const auto& field = std::get<specimen::HeightField>(hills.geometry);
    std::vector<ProbeRay> rays;
    for (const glm::vec3& direction :
         {glm::normalize(glm::vec3(0.1F, 0, -1)), glm::vec3(0.24F, -0.32F, -0.91651514F)}) {
        for (int row = 86; row < 170; ++row) {
            for (int column = 86; column < 170; ++column) {
                const glm::vec3 target(field.x_min + 0.5 * column * field.pitch_x,
                                       field.y_min + 0.5 * row * field.pitch_y, field.heights(column / 2, row / 2));
                rays.push_back({target - 10.0F * direction, direction});
            }
        }
    }
    const specimen::Intersector reference(hills);
    const auto expected = meet(reference, rays);
    for (const Traversal traversal : every_traversal) {
        // A float at 10 mm has steps of 1 nm, and so has the place where the ray comes to the specimen.
        const Comparison seen = compare(reference, rays, meet(hills, traversal, rays), expected, 4 * nm);
        EXPECT_EQ(seen.both, rays.size());
    }
}

} // namespace
} // namespace vkfv::trace
