// The host's intersector meets what all triangles tried in turn meet, also at the places where a ray could slip
// through.
#include "specimen/description.hpp"
#include "specimen/intersector.hpp"
#include "specimen/rays.hpp"
#include "specimen/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

namespace vkfv::specimen {
namespace {

using test::RandomRays;

HeightField bumpy_field(int columns, int rows) {
    HeightField field;
    field.heights = Grid<float>(columns, rows);
    field.pitch_x = 0.0013;
    field.pitch_y = 0.0017;
    field.x_min = -0.5 * (columns - 1) * field.pitch_x;
    field.y_min = -0.5 * (rows - 1) * field.pitch_y;
    RandomRays random(1);
    for (float& height : field.heights.values) {
        height = static_cast<float>(random.uniform(-0.002, 0.002));
    }
    return field;
}

glm::dvec3 vertex(const HeightField& field, int column, int row) {
    return {field.x_min + column * field.pitch_x, field.y_min + row * field.pitch_y,
            static_cast<double>(field.heights(column, row))};
}

struct Triangles {
    std::vector<std::array<glm::dvec3, 3>> list;

    explicit Triangles(const HeightField& field) {
        for (int row = 0; row + 1 < field.heights.rows; ++row) {
            for (int column = 0; column + 1 < field.heights.columns; ++column) {
                const glm::dvec3 low = vertex(field, column, row);
                const glm::dvec3 high = vertex(field, column + 1, row + 1);
                list.push_back({low, vertex(field, column + 1, row), high});
                list.push_back({low, high, vertex(field, column, row + 1)});
            }
        }
    }

    Mesh mesh() const {
        Mesh result;
        for (const auto& triangle : list) {
            const auto first = static_cast<unsigned>(result.vertices.size());
            result.triangles.emplace_back(first, first + 1, first + 2);
            result.vertices.insert(result.vertices.end(), triangle.begin(), triangle.end());
        }
        return result;
    }

    // The nearest distance by the normal form of each plane and the signs of three areas; none of the code under test
    // is used.
    std::optional<double> nearest(glm::dvec3 origin, glm::dvec3 direction) const {
        std::optional<double> best;
        for (const auto& [a, b, c] : list) {
            const glm::dvec3 normal = glm::cross(b - a, c - a);
            const double t = glm::dot(a - origin, normal) / glm::dot(direction, normal);
            const glm::dvec3 p = origin + t * direction;
            const bool inside = glm::dot(glm::cross(b - a, p - a), normal) >= 0 &&
                                glm::dot(glm::cross(c - b, p - b), normal) >= 0 &&
                                glm::dot(glm::cross(a - c, p - c), normal) >= 0;
            if (inside && t > 0 && (!best || t < *best)) {
                best = t;
            }
        }
        return best;
    }
};

TEST(Intersector, FindsTheNearestOfAllTriangles) {
    const HeightField field = bumpy_field(24, 17);
    const Triangles triangles(field);
    const Intersector by_walk(Specimen{field, {}});
    const Intersector by_hierarchy(Specimen{triangles.mesh(), {}});
    RandomRays random(2);
    int met = 0;
    int missed = 0;
    for (int i = 0; i < 4000; ++i) {
        // Rays come from above and from the side, down and up, and every eighth straight down.
        const glm::dvec3 origin(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), random.uniform(-0.001, 0.01));
        const glm::dvec3 direction = i % 8 == 0 ? glm::dvec3(0, 0, -1) : random.direction(0, 3.14159);
        const std::optional<double> expected = triangles.nearest(origin, direction);
        const auto walked = by_walk.hit(origin, direction);
        const auto searched = by_hierarchy.hit(origin, direction);
        ASSERT_EQ(walked.found == 1u, expected.has_value()) << i;
        // The mesh's vertices are floats: within 1e-9 mm of a border or a graze they may differ.
        missed += searched.found == walked.found ? 0 : 1;
        if (expected) {
            ++met;
            EXPECT_NEAR(walked.distance, *expected, 1e-12);
            EXPECT_NEAR(glm::length(walked.position - (origin + *expected * direction)), 0, 1e-12);
            EXPECT_GT(walked.normal.z, 0);
            EXPECT_NEAR(glm::length(walked.normal), 1, 1e-14);
        }
        if (searched.found == 1u && walked.found == 1u) {
            EXPECT_LE(glm::dot(searched.normal, direction), 0);
        }
    }
    EXPECT_LE(missed, 2);
    EXPECT_GT(met, 800);
}

// A stage whose vibration exceeds the range of numbers sends rays from there; no index of a cell may be computed from
// them, as it would lie outside the surface.
TEST(Intersector, MeetsNothingByARayThatIsNotFinite) {
    const HeightField field = bumpy_field(24, 17);
    const Specimen walked{field, {}}, searched{Triangles(field).mesh(), {}};
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN(), far = std::numeric_limits<double>::infinity();
    for (const Specimen* specimen : {&walked, &searched}) {
        const Intersector intersector(*specimen);
        EXPECT_EQ(intersector.hit({0, 0, 0.01}, {0, 0, -1}).found, 1u);
        for (const double value : {nothing, far, -far}) {
            EXPECT_EQ(intersector.hit({value, 0, 0.01}, {0, 0, -1}).found, 0u);
            EXPECT_EQ(intersector.hit({0, 0, value}, {0, 0, -1}).found, 0u);
            EXPECT_EQ(intersector.hit({0, 0, 0.01}, {value, 0, -1}).found, 0u);
        }
    }
}

// Aims rays exactly at corners, edges and diagonals, from all sides above: each must be stopped.
template <class Aim>
int slipped_through(const Intersector& intersector, const HeightField& field, Aim aim) {
    RandomRays random(3);
    int slipped = 0;
    for (int row = 1; row + 2 < field.heights.rows; ++row) {
        for (int column = 1; column + 2 < field.heights.columns; ++column) {
            for (int i = 0; i < 12; ++i) {
                const glm::dvec3 target = aim(column, row, random.uniform(0, 1));
                const glm::dvec3 axes[] = {{0, 0, 1}, {0.6, 0, 0.8}, {0, -0.6, 0.8}};
                const glm::dvec3 towards = i < 3 ? axes[i] : random.direction(0, 1.2);
                const auto hit = intersector.hit(target + 0.05 * towards, -towards);
                // Nothing beyond the target may be the first thing met.
                slipped += hit.found == 0u || hit.distance > 0.05 + 1e-9 ? 1 : 0;
            }
        }
    }
    return slipped;
}

TEST(Intersector, LetsNothingThroughAtCornersAndEdges) {
    // Heights and pitches have few bits, so that the rays do go through the corners exactly.
    HeightField field = bumpy_field(20, 20);
    field.pitch_x = field.pitch_y = 0x1p-10;
    field.x_min = field.y_min = -10 * 0x1p-10;
    for (float& height : field.heights.values) {
        // Slopes are up to 0.3, below the cotangent of the steepest ray's angle, 0.39: every place is in plain view.
        height = std::round(height * 0.05f * 0x1p20f) * 0x1p-20f;
    }
    const Triangles triangles(field);
    for (const Intersector& intersector :
         {Intersector(Specimen{field, {}}), Intersector(Specimen{triangles.mesh(), {}})}) {
        EXPECT_EQ(0, slipped_through(intersector, field, [&](int i, int j, double) { return vertex(field, i, j); }));
        for (const auto& [di, dj] : {std::pair{1, 0}, {0, 1}, {1, 1}}) {
            EXPECT_EQ(0, slipped_through(intersector, field, [&, di = di, dj = dj](int i, int j, double u) {
                          return glm::mix(vertex(field, i, j), vertex(field, i + di, j + dj), u);
                      }));
        }
    }
    // In the wrong twin a narrow slit is at the same places, and rays do come through.
    Mesh slit = triangles.mesh();
    for (std::size_t i = 0; i < slit.vertices.size(); i += 3) {
        const glm::vec3 centre = (slit.vertices[i] + slit.vertices[i + 1] + slit.vertices[i + 2]) / 3.0f;
        for (std::size_t k = i; k < i + 3; ++k) {
            slit.vertices[k] += 1e-4f * (centre - slit.vertices[k]);
        }
    }
    EXPECT_LT(100, slipped_through(Intersector(Specimen{slit, {}}), field,
                                   [&](int i, int j, double) { return vertex(field, i, j); }));
}

TEST(Intersector, RecordsEncloseTheSurface) {
    const HeightField field = bumpy_field(9, 12);
    const auto r = record(Specimen{field, Material::henyey_greenstein(0.7)}, 3);
    EXPECT_EQ(r.columns, 9);
    EXPECT_EQ(r.rows, 12);
    EXPECT_EQ(r.max_bounces, 3);
    EXPECT_EQ(r.material.lobe_0.parameter_0, 0.7);
    EXPECT_DOUBLE_EQ(r.x_max, field.x_max());
    for (const float height : field.heights.values) {
        EXPECT_LT(static_cast<float>(r.bottom), height);
        EXPECT_GT(static_cast<float>(r.top), height);
    }
    const auto mesh = record(Specimen{Triangles(field).mesh(), {}}, 1);
    EXPECT_EQ(mesh.kind, physics::f64::SPECIMEN_MESH);
    EXPECT_NEAR(mesh.top, r.top, 1e-12);
    EXPECT_NEAR(mesh.y_min, r.y_min, 1e-9);
}

TEST(Truth, OfAMeshIsThatOfTheFieldItCameFrom) {
    const HeightField field = bumpy_field(24, 17);
    const Mesh mesh = Triangles(field).mesh();
    const auto of_field = truth(Specimen{field, {}}, 40, 40, -0.02, -0.02, 0.001, 0.0011);
    const auto of_mesh = truth(Specimen{mesh, {}}, 40, 40, -0.02, -0.02, 0.001, 0.0011);
    int points = 0;
    for (std::size_t i = 0; i < of_field.height.values.size(); ++i) {
        const double a = of_field.height.values[i];
        const double b = of_mesh.height.values[i];
        EXPECT_EQ(std::isnan(a), std::isnan(b)) << i;
        if (!std::isnan(a)) {
            ++points;
            EXPECT_NEAR(a, b, 1e-8); // the mesh's x and y are floats: 1e-9 mm times slopes of a few
        }
    }
    EXPECT_GT(points, 400);
}

TEST(Truth, OfAPlaneIsThePlaneAndOfAnOverhangTheUppermost) {
    auto plane = test::over<Plane>(0.1, 0.0037);
    plane.tilt_x = 0.2;
    for (const Representation representation : {Representation::facets, Representation::analytic}) {
        plane.representation = representation;
        const auto map = truth(make({.shape = plane}), 30, 30, -0.058, -0.058, 0.004, 0.004);
        for (int i = 0; i < 30; ++i) {
            const bool inside = std::abs(map.x(i)) + 0.4 * 0.004 <= 0.05;
            EXPECT_EQ(!inside, std::isnan(map.height(i, 15))) << i;
            if (inside) {
                EXPECT_NEAR(map.height(i, 15), map.x(i) * std::tan(0.2), 1e-9); // heights in float
            }
        }
        EXPECT_TRUE(std::isnan(map.height(15, 0)));
    }
    Mesh shelves;
    for (const float z : {0.0f, 0.003f, -0.001f}) {
        const auto first = static_cast<unsigned>(shelves.vertices.size());
        shelves.vertices.insert(shelves.vertices.end(), {{-1, -1, z}, {1, -1, z}, {0, 1, z}});
        shelves.triangles.emplace_back(first, first + 1, first + 2);
    }
    EXPECT_FLOAT_EQ(static_cast<float>(truth(Specimen{shelves, {}}, 1, 1, 0, 0, 0.1, 0.1).height(0, 0)), 0.003f);
}

} // namespace
} // namespace vkfv::specimen
