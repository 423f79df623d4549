// Analytic surfaces, and the bounds by which they are traversed, agree with facets and with the host's reference.
#include "traversal_rays.hpp"

#include "trace/structures/pyramid.hpp"

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

// The heights at which rays of slope tan(theta) meet two surfaces that are `gap` apart vertically differ by
// at most gap / (1 - slope tan(theta)), where `slope` bounds both surfaces' slopes. Float adds rounding of
// both.
double along_ray(double gap, double slope, double aperture) {
    return (gap + 4 * rounding) / (1 - slope * std::tan(std::asin(aperture)));
}

struct Pair {
    specimen::Analytic analytic;
    specimen::HeightField facets;
    double bound; // of the vertical distance of the two, mm
    double slope; // of both
};

specimen::Analytic analytic_shape(std::uint32_t shape, double p0, double p1, double p2, double half) {
    specimen::Analytic surface;
    surface.shape = shape;
    surface.parameters[0] = p0;
    surface.parameters[1] = p1;
    surface.parameters[2] = p2;
    surface.x_min = surface.y_min = -half;
    surface.x_max = surface.y_max = half;
    return surface;
}

constexpr double pitch = 0.0002;
constexpr int points = 513;
constexpr double half = 0.5 * (points - 1) * pitch;

// A function of x alone lies within max |h''| pitch^2 / 8 of its chords.
Pair sinusoid() {
    const double amplitude = 0.001;
    const double number = two_pi / 0.02;
    return {analytic_shape(physics::f64::SHAPE_SINUSOID, amplitude, 0.02, 0, half),
            make_field(points, pitch, [=](double x, double) { return amplitude * std::sin(number * x); }),
            amplitude * number * number * pitch * pitch / 8, amplitude * number};
}

// The bound of h = A sin(2 pi p(x)) with p'' = s is |h''| <= A ((2 pi p')^2 + 2 pi s).
Pair chirp() {
    const double amplitude = 0.0005;
    const double start = 1 / 0.03;
    const double stop = 1 / 0.01;
    const double sweep = (stop - start) / (2 * half);
    return {analytic_shape(physics::f64::SHAPE_CHIRP, amplitude, 0.03, 0.01, half),
            make_field(points, pitch,
                       [=](double x, double) {
                           const double s = x + half;
                           return amplitude * std::sin(two_pi * (start * s + 0.5 * sweep * s * s));
                       }),
            amplitude * (two_pi * stop * two_pi * stop + two_pi * sweep) * pitch * pitch / 8,
            amplitude * two_pi * stop};
}

// The whole footprint lies on the cap. The error of linear interpolation on a triangle of circumradius pitch
// / sqrt(2) is at most that squared / 2 times the largest curvature R^2 / (R^2 - r^2)^(3/2).
Pair sphere() {
    const double radius = 0.2;
    const double cap = 0.05; // its rim stands at r = sqrt(2 R cap - cap^2) = 0.13 mm, beyond the corners at 0.073 mm
    const double r_squared = 2 * half * half;
    const double z = std::sqrt(radius * radius - r_squared);
    return {analytic_shape(physics::f64::SHAPE_SPHERE, radius, cap, 0, half),
            make_field(points, pitch,
                       [=](double x, double y) { return cap - radius + std::sqrt(radius * radius - x * x - y * y); }),
            pitch * pitch / 4 * radius * radius / (z * z * z), std::sqrt(r_squared) / z};
}

// The lattice is interpolated by cubic convolution, and compared with the facets over the same points. Along a line its
// distance from the chord is u (1 - u) / 2 times a mean of the neighbouring second differences, so at most 1/8 of them;
// the weights across add up to at most 5/4 in size. The bilinear patch between is within 1/4 of its mixed difference of
// the facets.
Pair lattice() {
    Pair pair;
    pair.facets = make_field(points, pitch, RandomWaves(0.0002, 0.015, 11));
    pair.analytic = analytic_shape(physics::f64::SHAPE_PLANE, 0, 0, 0, half);
    pair.analytic.lattice = pair.facets;
    const Grid<float>& h = pair.facets.heights;
    double along_x = 0;
    double along_y = 0;
    double mixed = 0;
    double slope = 0;
    for (int j = 1; j + 1 < points; ++j) {
        for (int i = 1; i + 1 < points; ++i) {
            const double centre = h(i, j);
            along_x = std::max(along_x, std::abs(h(i - 1, j) - 2 * centre + h(i + 1, j)));
            along_y = std::max(along_y, std::abs(h(i, j - 1) - 2 * centre + h(i, j + 1)));
            mixed = std::max(mixed, std::abs(centre - h(i + 1, j) - h(i, j + 1) + h(i + 1, j + 1)));
            slope = std::max(slope, std::hypot(h(i + 1, j) - centre, h(i, j + 1) - centre) / pitch);
        }
    }
    pair.bound = 5.0 / 32 * along_x + along_y / 8 + mixed / 4;
    // The interpolant's slope along a line is at its extreme 5/4 of the chord's less 1/8 of either
    // neighbour's, and the weights across add up to at most 5/4 in size.
    pair.slope = (5.0 / 4 + 2.0 / 8) * 5.0 / 4 * slope;
    return pair;
}

class FacetsAndFunction : public testing::TestWithParam<std::pair<const char*, Pair (*)()>> {};

TEST_P(FacetsAndFunction, AgreeWithinTheInterpolationsBound) {
    const Pair pair = GetParam().second();
    const specimen::Specimen facets{pair.facets, {}};
    const specimen::Specimen function{pair.analytic, {}};
    const double aperture = 0.3;
    const double tolerance = along_ray(pair.bound, pair.slope, aperture);
    // A shift by 3 nm must stand out of the tolerance.
    ASSERT_LT(2 * tolerance, 3 * nm / (1 + pair.slope * std::tan(std::asin(aperture))));

    // Two cells from the border, where the lattice goes on level, its distance from the facets is not bounded so; and
    // facets reach no further than their own top plane.
    auto rays = rays_from_top(function, 50'000, aperture, -0.004, 13);
    const specimen::Intersector reference(facets);
    const auto on_facets = meet(facets, Traversal::quadtree, rays);
    const auto by_march = meet(function, Traversal::quadtree, rays);
    const auto by_boxes = meet(function, Traversal::ray_query, rays);
    const auto by_hierarchy = meet(function, Traversal::bvh, rays);
    const auto moved = meet(shifted(facets, 3 * nm), Traversal::quadtree, rays);

    for (const auto& hits : {by_march, by_boxes, by_hierarchy}) {
        const Comparison seen = compare(reference, rays, on_facets, hits, tolerance);
        EXPECT_EQ(seen.both, rays.size());
        EXPECT_EQ(seen.one_only + seen.apart, 0u);
        // The normals of a chord and of its arc differ by at most the curvature times a pitch.
        EXPECT_LT(seen.largest_normal, 8 * pair.bound / pitch * std::numbers::sqrt2 + 0.001);
    }
    EXPECT_EQ(compare(reference, rays, by_march, by_boxes, nm).both, rays.size());
    EXPECT_EQ(compare(reference, rays, by_march, by_hierarchy, nm).both, rays.size());
    EXPECT_EQ(compare(reference, rays, moved, by_march, tolerance).both, 0u);
}

INSTANTIATE_TEST_SUITE_P(Traversal, FacetsAndFunction,
                         testing::Values(std::pair("sinusoid", &sinusoid), std::pair("chirp", &chirp),
                                         std::pair("sphere", &sphere), std::pair("lattice", &lattice)),
                         [](const auto& info) { return std::string(info.param.first); });

TEST(Traversal, FunctionsAreMetAsOnTheHost) {
    for (const auto& make_pair : {&sinusoid, &lattice}) {
        const specimen::Specimen function{make_pair().analytic, {}};
        const specimen::Intersector reference(function);
        const auto down = rays_from_top(function, 20'000, 0.4, 0, 17);
        const auto rays = scattered_rays(meet(function, Traversal::quadtree, down), 17);
        for (const auto& probes : {down, rays}) {
            const auto expected = meet(reference, probes);
            for (const Traversal traversal : every_traversal) {
                const Comparison seen = compare(reference, probes, meet(function, traversal, probes), expected, nm);
                EXPECT_EQ(seen.one_only + seen.apart, 0u);
                EXPECT_GT(seen.both, 0u);
            }
        }
    }
}

TEST(Pyramid, EnclosesTheSurface) {
    std::mt19937 generator(23);
    std::uniform_real_distribution<double> uniform;
    for (const auto& make_pair : {&sinusoid, &chirp, &sphere, &lattice}) {
        const specimen::Analytic surface = make_pair().analytic;
        specimen::Analytic shape = surface;
        shape.lattice.reset();
        const Pyramid pyramid = make_pyramid(surface, specimen::record({shape, {}}, 1));
        const auto record = specimen::record({surface, {}}, 1);
        struct Scene {
            const specimen::Analytic* surface;
            double lattice_at(int column, int row) const { return surface->lattice->heights(column, row); }
        };
        const Scene scene{&surface};
        EXPECT_EQ(glm::ivec2(pyramid.header.cells_x, pyramid.header.cells_y), pyramid_cells(surface));
        std::size_t outside = 0;
        std::size_t outside_half = 0;
        for (int k = 0; k < 20'000; ++k) {
            const double u = uniform(generator);
            const double v = uniform(generator);
            const double height =
                physics::f64::surface_height(scene, record, -half + u * 2 * half, -half + v * 2 * half).height;
            for (int level = 0; level <= pyramid.header.top_level; ++level) {
                const glm::dvec2 range = pyramid.range(level, static_cast<int>(u * pyramid.header.cells_x) >> level,
                                                       static_cast<int>(v * pyramid.header.cells_y) >> level);
                outside += height < range.x || height > range.y ? 1 : 0;
                const double middle = 0.5 * (range.x + range.y);
                outside_half += std::abs(height - middle) > 0.25 * (range.y - range.x) ? 1 : 0;
            }
        }
        EXPECT_EQ(outside, 0u);
        EXPECT_GT(outside_half, 1000u); // half as wide would not do: the ranges are not idle
    }
}

// The truth is brute force: no point of the surface within a block's side of the block stands over its ceiling, and
// every ceiling is needed; the steepest facet is the one that a search by cross products finds.
TEST(Ceilings, StandOverAllThatIsNear) {
    auto field = make_field(151, 0.001, RandomWaves(0.004, 0.02, 29));
    field.pitch_y = 0.0013; // blocks are counted in cells
    const Ceilings ceilings = make_ceilings(field);
    const kernels::CeilingsHeader& header = ceilings.header;
    EXPECT_LT(header.fine_level, header.coarse_level);
    const auto check = [&](int level, int first, int columns) {
        const int side = 1 << level;
        for (int row = 0; row * side < 150; ++row) {
            for (int column = 0; column * side < 150; ++column) {
                float highest = -1;
                for (int j = std::max(0, (row - 1) * side); j <= std::min(150, (row + 2) * side); ++j) {
                    for (int i = std::max(0, (column - 1) * side); i <= std::min(150, (column + 2) * side); ++i) {
                        highest = std::max(highest, field.heights(i, j));
                    }
                }
                const float ceiling = ceilings.heights.at(static_cast<std::size_t>(first + row * columns + column));
                EXPECT_GT(ceiling, highest);
                EXPECT_LT(static_cast<double>(ceiling - highest), 2 * rounding);
            }
        }
    };
    check(header.fine_level, 0, header.fine_columns);
    check(header.coarse_level, header.coarse_first, header.coarse_columns);

    double steepest = 0;
    for (int row = 0; row < 150; ++row) {
        for (int column = 0; column < 150; ++column) {
            const auto point = [&](int i, int j) {
                return glm::dvec3((column + i) * field.pitch_x, (row + j) * field.pitch_y,
                                  field.heights(column + i, row + j));
            };
            for (const glm::dvec3& normal : {glm::cross(point(1, 0) - point(0, 0), point(1, 1) - point(0, 0)),
                                             glm::cross(point(1, 1) - point(0, 0), point(0, 1) - point(0, 0))}) {
                steepest = std::max(steepest, std::hypot(normal.x, normal.y) / normal.z);
            }
        }
    }
    EXPECT_GT(static_cast<double>(header.steepest), steepest);
    EXPECT_LT(static_cast<double>(header.steepest), 1.001 * steepest);
}

} // namespace
} // namespace vkfv::trace
