#include "vulkan/acceleration_structure.hpp"

#include "core/messages/error.hpp"
#include "shared_device.hpp"
#include "spirv/probe_vulkan_ray_query.h"
#include "vulkan/kernel.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace vkfv::vulkan {
namespace {

// The records have the layouts of probe_vulkan_ray_query.comp.
struct Ray {
    glm::vec3 origin;
    float t_min;
    glm::vec3 direction;
    float t_max;
};
struct Sphere {
    glm::vec3 centre;
    float radius;
};
struct Hit {
    float t;
    std::uint32_t primitive;
    std::uint32_t candidates;
};
struct Push {
    std::uint32_t count;
    std::uint32_t flags;
};

// The values are those of gl_RayFlags...EXT.
constexpr std::uint32_t no_flags = 0;
constexpr std::uint32_t cull_back = 0x10;
constexpr std::uint32_t cull_front = 0x20;

std::vector<Hit> trace(const AccelerationStructure& structure, const std::vector<Ray>& rays,
                       const std::vector<Sphere>& spheres = {}, std::uint32_t flags = no_flags) {
    const Device& device = shared_device();
    Buffer ray_buffer(device, rays.size() * sizeof(Ray));
    ray_buffer.write_values(std::span(rays));
    Buffer sphere_buffer(device, spheres.size() * sizeof(Sphere));
    sphere_buffer.write_values(std::span(spheres));
    const Buffer hits(device, rays.size() * sizeof(Hit));
    const Kernel kernel(device, "probe_vulkan_ray_query", probe_vulkan_ray_query,
                        {{0, BindingKind::acceleration_structure},
                         {1, BindingKind::storage_buffer},
                         {2, BindingKind::storage_buffer},
                         {3, BindingKind::storage_buffer}},
                        sizeof(Push));
    const Push push{static_cast<std::uint32_t>(rays.size()), flags};
    Commands commands(device);
    commands.dispatch(kernel, std::vector<Binding>{{0, &structure}, {1, &ray_buffer}, {2, &sphere_buffer}, {3, &hits}},
                      push, (push.count + 63) / 64);
    commands.submit_and_wait();
    return hits.read_values<Hit>(rays.size());
}

// The plane z = slope_x x + slope_y y over [-1, 1]^2, its triangles in the order of their median splits.
struct TiltedPlane {
    static constexpr int cells = 32;
    static constexpr double slope_x = 0.3;
    static constexpr double slope_y = -0.2;
    std::vector<glm::vec3> vertices;
    std::vector<glm::uvec3> triangles; // counter-clockwise seen from +z

    TiltedPlane() {
        for (int row = 0; row <= cells; ++row) {
            for (int column = 0; column <= cells; ++column) {
                const double x = -1.0 + 2.0 * column / cells;
                const double y = -1.0 + 2.0 * row / cells;
                vertices.emplace_back(x, y, slope_x * x + slope_y * y);
            }
        }
        std::vector<glm::uvec3> by_row;
        std::vector<glm::vec3> centres;
        for (std::uint32_t row = 0; row < cells; ++row) {
            for (std::uint32_t column = 0; column < cells; ++column) {
                const std::uint32_t corner = row * (cells + 1) + column;
                by_row.emplace_back(corner, corner + 1, corner + cells + 2);
                by_row.emplace_back(corner, corner + cells + 2, corner + cells + 1);
            }
        }
        for (const glm::uvec3& t : by_row) {
            centres.push_back((vertices[t.x] + vertices[t.y] + vertices[t.z]) / 3.0F);
        }
        for (const std::uint32_t index : median_order(centres)) {
            triangles.push_back(by_row[index]);
        }
    }
};

std::vector<Ray> random_rays(std::size_t count, float z) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> lateral(-1.5F, 1.5F);
    std::uniform_real_distribution<float> tilt(-0.5F, 0.5F);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3 direction = glm::normalize(glm::vec3(tilt(random), tilt(random), z > 0 ? -1.0F : 1.0F));
        rays.push_back({{lateral(random), lateral(random), z}, 0.0F, direction, 100.0F});
    }
    return rays;
}

struct Comparison {
    int hits = 0;
    int wrong = 0; // hit by one only
    double largest_error = 0;
};

// Compares hits with z = slope_x x + slope_y y in double. Rays within 1e-4 of the border belong to neither side.
Comparison compare_with_plane(const std::vector<Ray>& rays, const std::vector<Hit>& hits, double slope_x,
                              double slope_y) {
    Comparison comparison;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const glm::dvec3 o = rays[i].origin;
        const glm::dvec3 d = rays[i].direction;
        const double t = (slope_x * o.x + slope_y * o.y - o.z) / (d.z - slope_x * d.x - slope_y * d.y);
        const glm::dvec3 p = o + t * d;
        const double outside = std::max(std::abs(p.x), std::abs(p.y)) - 1.0;
        if (std::abs(outside) < 1e-4) {
            continue;
        }
        const bool hit = hits[i].t >= 0;
        comparison.hits += hit ? 1 : 0;
        comparison.wrong += hit != (outside < 0) ? 1 : 0;
        if (hit && outside < 0) {
            comparison.largest_error = std::max(comparison.largest_error, std::abs(hits[i].t - t));
        }
    }
    return comparison;
}

// Distances and coordinates stay below 4; the intersection rounds about ten times in float (2^-24 each) at
// that size, not all in one direction: 10 * 4 * 2^-24 = 2.4e-6.
constexpr double float_bound = 2.4e-6;

class RayQuery : public ::testing::Test {
  protected:
    // Without ray query a device must say so; with it, it must trace.
    static bool offered() {
        if (!shared_device().report().ray_query) {
            const std::vector<Box> boxes = {{glm::vec3(0), glm::vec3(1)}};
            EXPECT_THROW(AccelerationStructure::of_boxes(shared_device(), boxes), DeviceError);
            EXPECT_THROW(Kernel(shared_device(), "probe_vulkan_ray_query", probe_vulkan_ray_query,
                                {{0, BindingKind::acceleration_structure}}),
                         DeviceError);
        }
        return shared_device().report().ray_query;
    }
};

TEST_F(RayQuery, MeetsTrianglesWhereThePlaneIs) {
    if (!offered()) {
        return;
    }
    const TiltedPlane plane;
    const AccelerationStructure structure =
        AccelerationStructure::of_triangles(shared_device(), plane.vertices, plane.triangles);
    EXPECT_GT(structure.bytes(), plane.triangles.size());
    const std::vector<Ray> rays = random_rays(20'000, 2.0F);
    const std::vector<Hit> hits = trace(structure, rays);

    const Comparison right = compare_with_plane(rays, hits, TiltedPlane::slope_x, TiltedPlane::slope_y);
    EXPECT_GT(right.hits, 5'000);
    EXPECT_EQ(right.wrong, 0);
    EXPECT_LT(right.largest_error, float_bound);
    // The wrong twin is a plane tilted by 1e-4 more.
    const Comparison twin = compare_with_plane(rays, hits, TiltedPlane::slope_x + 1e-4, TiltedPlane::slope_y);
    EXPECT_GT(twin.largest_error, 10 * float_bound);

    // The primitive is the triangle that was given at that place: it holds the hit's x and y.
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].t >= 0) {
            const glm::uvec3 t = plane.triangles.at(hits[i].primitive);
            const glm::vec3 p = rays[i].origin + hits[i].t * rays[i].direction;
            const glm::vec3 lower = glm::min(glm::min(plane.vertices[t.x], plane.vertices[t.y]), plane.vertices[t.z]);
            const glm::vec3 upper = glm::max(glm::max(plane.vertices[t.x], plane.vertices[t.y]), plane.vertices[t.z]);
            ASSERT_TRUE(p.x > lower.x - float_bound && p.x < upper.x + float_bound && p.y > lower.y - float_bound &&
                        p.y < upper.y + float_bound)
                << i;
        }
    }
}

TEST_F(RayQuery, TheFrontOfATriangleIsWhereItIsCounterClockwise) {
    if (!offered()) {
        return;
    }
    const TiltedPlane plane;
    const AccelerationStructure structure =
        AccelerationStructure::of_triangles(shared_device(), plane.vertices, plane.triangles);
    const std::vector<Ray> above = {{{0.11F, 0.23F, 2.0F}, 0.0F, {0, 0, -1}, 100.0F}};
    const std::vector<Ray> below = {{{0.11F, 0.23F, -2.0F}, 0.0F, {0, 0, 1}, 100.0F}};
    EXPECT_GT(trace(structure, above, {}, cull_back).front().t, 0);
    EXPECT_LT(trace(structure, below, {}, cull_back).front().t, 0);
    EXPECT_LT(trace(structure, above, {}, cull_front).front().t, 0);
    EXPECT_GT(trace(structure, below, {}, cull_front).front().t, 0);
    EXPECT_GT(trace(structure, below).front().t, 0);
}

TEST_F(RayQuery, MeetsTheNearestOfTheSpheresInItsBoxes) {
    if (!offered()) {
        return;
    }
    std::vector<Sphere> spheres;
    std::vector<Box> boxes;
    constexpr float radius = 0.2F;
    for (int layer = 0; layer < 2; ++layer) {
        for (int row = -3; row <= 3; ++row) {
            for (int column = -3; column <= 3; ++column) {
                const glm::vec3 centre(0.3F * static_cast<float>(column) + 0.15F * static_cast<float>(layer),
                                       0.3F * static_cast<float>(row), -0.5F * static_cast<float>(layer));
                spheres.push_back({centre, radius});
                boxes.push_back({centre - radius, centre + radius});
            }
        }
    }
    const AccelerationStructure structure = AccelerationStructure::of_boxes(shared_device(), boxes);
    const std::vector<Ray> rays = random_rays(20'000, 2.0F);
    const std::vector<Hit> hits = trace(structure, rays, spheres);

    const auto largest_error = [&](double true_radius, int& compared) {
        double largest = 0;
        compared = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const glm::dvec3 o = rays[i].origin;
            const glm::dvec3 d = glm::normalize(glm::dvec3(rays[i].direction));
            double nearest = std::numeric_limits<double>::infinity();
            bool grazing = false;
            for (const Sphere& sphere : spheres) {
                // The truth is the textbook's quadratic equation, in double.
                const glm::dvec3 f = o - glm::dvec3(sphere.centre);
                const double b = glm::dot(f, d);
                const double discriminant = b * b - glm::dot(f, f) + true_radius * true_radius;
                // sqrt magnifies what is rounded before it: keep away from the rim, where it is singular.
                grazing = grazing || std::abs(discriminant) < 0.1 * true_radius * true_radius;
                if (discriminant > 0) {
                    nearest = std::min(nearest, -b - std::sqrt(discriminant));
                }
            }
            if (grazing) {
                continue;
            }
            if (!std::isfinite(nearest) || hits[i].t < 0) {
                EXPECT_EQ(std::isfinite(nearest), hits[i].t >= 0) << i;
                continue;
            }
            ++compared;
            largest = std::max(largest, std::abs(nearest - static_cast<double>(hits[i].t)));
        }
        return largest;
    };
    // An error e of the foot's distance (at most the radius) from the centre moves t by e r / sqrt(0.1 r^2)
    // = 3.2 e.
    int compared = 0;
    EXPECT_LT(largest_error(radius, compared), (1 + 3.2) * float_bound);
    EXPECT_GT(compared, 1'000);
    // The wrong twin has spheres larger by 1 in 1000, of which the nearest points lie 2e-4 nearer.
    EXPECT_GT(largest_error(1.001 * radius, compared), 2e-4);
}

TEST_F(RayQuery, ARayInTheFaceOfABoxIsOfferedIt) {
    if (!offered()) {
        return;
    }
    const std::vector<Box> boxes = {{{-0.7F, -0.3F, 0.1F}, {0.9F, 0.4F, 0.1F}}}; // flat, too
    const AccelerationStructure structure = AccelerationStructure::of_boxes(shared_device(), boxes);
    const std::vector<Sphere> spheres = {{glm::vec3(0), 0.0F}};
    const glm::vec3 across = glm::normalize(glm::vec3(1.0F, 0.1F, 0.0F));
    const std::vector<Hit> in_face = trace(structure,
                                           {{{-2.0F, 0.0F, 0.1F}, 0.0F, across, 10.0F},
                                            {{-2.0F, 0.4F, 0.1F}, 0.0F, {1, 0, 0}, 10.0F},
                                            {{0.9F, -2.0F, 0.1F}, 0.0F, {0, 1, 0}, 10.0F},
                                            {{0.9F, 0.4F, 2.0F}, 0.0F, {0, 0, -1}, 10.0F}},
                                           spheres);
    for (const Hit& hit : in_face) {
        EXPECT_GE(hit.candidates, 1U);
    }
    // The wrong twin aims 1e-5 beside the faces, ten times the padding.
    const std::vector<Hit> beside = trace(structure,
                                          {{{-2.0F, 0.0F, 0.10001F}, 0.0F, across, 10.0F},
                                           {{-2.0F, 0.40001F, 0.1F}, 0.0F, {1, 0, 0}, 10.0F},
                                           {{0.90001F, -2.0F, 0.1F}, 0.0F, {0, 1, 0}, 10.0F}},
                                          spheres);
    for (const Hit& hit : beside) {
        EXPECT_EQ(hit.candidates, 0U);
    }
}

TEST_F(RayQuery, PrimitivesThatAreNoneAreRefused) {
    if (!offered()) {
        return;
    }
    const Device& device = shared_device();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<glm::vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<glm::vec3> broken = {{0, 0, 0}, {1, 0, 0}, {0, 1, nan}};
    const std::vector<glm::uvec3> triangles = {{0, 1, 2}};
    EXPECT_NO_THROW(AccelerationStructure::of_triangles(device, vertices, triangles));
    EXPECT_THROW(AccelerationStructure::of_triangles(device, vertices, {}), std::logic_error);
    EXPECT_THROW(AccelerationStructure::of_triangles(device, broken, triangles), std::logic_error);
    EXPECT_THROW(AccelerationStructure::of_triangles(device, vertices, std::vector<glm::uvec3>{{0, 1, 3}}),
                 std::logic_error);
    EXPECT_THROW(AccelerationStructure::of_boxes(device, {}), std::logic_error);
    EXPECT_THROW(AccelerationStructure::of_boxes(device, std::vector<Box>{{glm::vec3(0), glm::vec3(1, nan, 1)}}),
                 std::logic_error);
    EXPECT_THROW(AccelerationStructure::of_boxes(device, std::vector<Box>{{glm::vec3(1), glm::vec3(0)}}),
                 std::logic_error);
}

// Whether each half of every half lies on its side of the longest axis.
bool is_split_by_medians(const std::vector<glm::vec3>& centres, const std::vector<std::uint32_t>& order,
                         std::size_t first, std::size_t count) {
    if (count < 2) {
        return true;
    }
    glm::vec3 lower(std::numeric_limits<float>::infinity());
    glm::vec3 upper(-std::numeric_limits<float>::infinity());
    for (std::size_t i = first; i < first + count; ++i) {
        lower = glm::min(lower, centres[order[i]]);
        upper = glm::max(upper, centres[order[i]]);
    }
    const glm::vec3 extent = upper - lower;
    const std::size_t left = count - count / 2;
    float left_maximum[3];
    float right_minimum[3];
    bool split = false;
    for (int axis = 0; axis < 3; ++axis) {
        left_maximum[axis] = -std::numeric_limits<float>::infinity();
        right_minimum[axis] = std::numeric_limits<float>::infinity();
        for (std::size_t i = first; i < first + count; ++i) {
            const float c = centres[order[i]][axis];
            if (i < first + left) {
                left_maximum[axis] = std::max(left_maximum[axis], c);
            } else {
                right_minimum[axis] = std::min(right_minimum[axis], c);
            }
        }
        const bool longest = extent[axis] == std::max({extent.x, extent.y, extent.z});
        split = split || (longest && left_maximum[axis] <= right_minimum[axis]);
    }
    return split && is_split_by_medians(centres, order, first, left) &&
           is_split_by_medians(centres, order, first + left, count - left);
}

TEST(MedianOrder, IsAPermutationSplitByMedians) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
    for (const std::size_t count : {0U, 1U, 2U, 3U, 7U, 64U, 1001U}) {
        std::vector<glm::vec3> centres;
        for (std::size_t i = 0; i < count; ++i) {
            centres.emplace_back(uniform(random), 3.0F * uniform(random), 0.1F * uniform(random));
        }
        const std::vector<std::uint32_t> order = median_order(centres);
        std::vector<std::uint32_t> identity(count);
        std::iota(identity.begin(), identity.end(), 0U);
        EXPECT_THAT(order, ::testing::UnorderedElementsAreArray(identity));
        EXPECT_TRUE(is_split_by_medians(centres, order, 0, count)) << count;
        if (count > 3) { // the wrong twin: as they came
            EXPECT_FALSE(is_split_by_medians(centres, identity, 0, count)) << count;
        }
    }
}

TEST(MedianOrder, CoincidentCentresKeepTheirOrderInSplits) {
    // All centres are equal: ties fall by index, so each half holds the lower indices.
    const std::vector<glm::vec3> centres(100, glm::vec3(1, 2, 3));
    const std::vector<std::uint32_t> order = median_order(centres);
    std::vector<std::uint32_t> identity(100);
    std::iota(identity.begin(), identity.end(), 0U);
    EXPECT_EQ(order, identity);
}

TEST(MedianOrder, RefusesCentresThatAreNotFinite) {
    const std::vector<glm::vec3> centres = {glm::vec3(0), glm::vec3(std::numeric_limits<float>::infinity(), 0, 0)};
    EXPECT_THROW(static_cast<void>(median_order(centres)), std::logic_error);
}

} // namespace
} // namespace vkfv::vulkan
