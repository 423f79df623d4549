// Scattered points are triangulated by Delaunay's definition, the surface between them keeps the bound of its
// interpolation, and files of points are read as programs write them, or refused where they are damaged.
#include "specimen/delaunay.hpp"
#include "specimen/description.hpp"
#include "specimen/files.hpp"
#include "specimen/kinds.hpp"

#include "temporary_files.hpp"

#include <fmt/format.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace vkfv::specimen {
namespace {

using testing::HasSubstr;
using ScatteredPoints = test::TemporaryFiles;

struct Circle {
    glm::dvec2 centre;
    double radius;
};

// The circle through a triangle's corners.
Circle circle_through(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const glm::dvec2 ab = b - a, ac = c - a;
    const double twice = 2 * (ab.x * ac.y - ab.y * ac.x);
    const glm::dvec2 from_a = glm::dvec2(ac.y * glm::dot(ab, ab) - ab.y * glm::dot(ac, ac),
                                         ab.x * glm::dot(ac, ac) - ac.x * glm::dot(ab, ab)) /
                              twice;
    return {a + from_a, glm::length(from_a)};
}

double area_of(const std::vector<glm::dvec2>& points, const glm::uvec3& t) {
    const glm::dvec2 ab = points[t.y] - points[t.x], ac = points[t.z] - points[t.x];
    return 0.5 * (ab.x * ac.y - ab.y * ac.x);
}

// The greatest depth of any point within any triangle's circle.
double depth_in_circles(const std::vector<glm::dvec2>& points, const std::vector<glm::uvec3>& triangles) {
    double deepest = 0;
    for (const glm::uvec3& t : triangles) {
        const Circle circle = circle_through(points[t.x], points[t.y], points[t.z]);
        for (const glm::dvec2& point : points) {
            deepest = std::max(deepest, circle.radius - glm::distance(circle.centre, point));
        }
    }
    return deepest;
}

// The hull's area, by A. M. Andrew's monotone chain, Inf. Process. Lett. 9 (1979) 216.
double hull_area(std::vector<glm::dvec2> points) {
    std::ranges::sort(points, [](const auto& a, const auto& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    double twice = 0;
    for (const double side : {1.0, -1.0}) {
        std::vector<glm::dvec2> chain;
        for (const glm::dvec2& point : points) {
            const auto turns_back = [&] {
                const glm::dvec2 u = chain.back() - chain[chain.size() - 2], v = point - chain.back();
                return side * (u.x * v.y - u.y * v.x) <= 0;
            };
            while (chain.size() >= 2 && turns_back()) {
                chain.pop_back();
            }
            chain.push_back(point);
        }
        for (std::size_t k = 1; k < chain.size(); ++k) {
            twice += side * (chain[k - 1].x * chain[k].y - chain[k].x * chain[k - 1].y);
        }
    }
    return 0.5 * twice;
}

// Expects that the triangles cover the hull once: all go round the same way, no two are on the same side of an edge,
// and their areas add up.
void expect_cover(const std::vector<glm::dvec2>& points, const std::vector<glm::uvec3>& triangles, double expected) {
    double area = 0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (const glm::uvec3& t : triangles) {
        EXPECT_GT(area_of(points, t), 0);
        area += area_of(points, t);
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(++sides[std::pair(t[k], t[(k + 1) % 3])], 1);
        }
    }
    EXPECT_NEAR(area, expected, 1e-6 * expected);
}

std::vector<glm::dvec2> random_points(int count, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<glm::dvec2> points;
    for (int k = 0; k < count; ++k) {
        const double x = uniform(generator);
        points.emplace_back(x, uniform(generator));
    }
    return points;
}

TEST(Delaunay, NoPointLiesInATrianglesCircle) {
    // Points are rounded to 2^-32 of their extent of 2; a circle moves by more only where it is far larger than that.
    constexpr double rounding = 1e-7;
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
        const auto points = random_points(150, seed);
        auto triangles = delaunay(points).triangles;
        expect_cover(points, triangles, hull_area(points));
        EXPECT_LT(depth_in_circles(points, triangles), rounding);
        // The wrong twin: two neighbours share the other diagonal of their quadrilateral.
        bool swapped = false;
        for (std::size_t i = 0; i < triangles.size() && !swapped; ++i) {
            for (std::size_t j = 0; j < triangles.size() && !swapped; ++j) {
                for (int k = 0; k < 9 && !swapped; ++k) {
                    const glm::uvec3 s = triangles[i], t = triangles[j];
                    const auto a = s[k / 3], b = s[(k / 3 + 1) % 3], c = s[(k / 3 + 2) % 3], d = t[(k + 2) % 3];
                    if (i != j && t[k % 3] == b && t[(k + 1) % 3] == a && area_of(points, {c, a, d}) > 0.001 &&
                        area_of(points, {d, b, c}) > 0.001) {
                        triangles[i] = {c, a, d};
                        triangles[j] = {d, b, c};
                        swapped = true;
                    }
                }
            }
        }
        ASSERT_TRUE(swapped);
        EXPECT_GT(depth_in_circles(points, triangles), 1e3 * rounding);
    }
}

// Four points of every cell lie on one circle, and all points of a border on one line but for rounding.
TEST(Delaunay, LatticesAreCoveredOnceHoweverTheyAreTurned) {
    constexpr int side = 30;
    for (const double turn : {0.0, 0.3, pi / 4}) {
        std::vector<glm::dvec2> points;
        for (int i = 0; i <= side; ++i) {
            for (int j = 0; j <= side; ++j) {
                points.emplace_back(0.1 * (i * std::cos(turn) - j * std::sin(turn)),
                                    0.1 * (i * std::sin(turn) + j * std::cos(turn)));
            }
        }
        const auto triangles = delaunay(points).triangles;
        EXPECT_EQ(triangles.size(), 2u * side * side) << turn;
        expect_cover(points, triangles, 0.01 * side * side);
    }
}

TEST(Delaunay, PointsOnALineOrAtOnePlaceHaveNoTriangle) {
    std::vector<glm::dvec2> line;
    for (int k = 0; k < 50; ++k) {
        line.emplace_back(0.1 * k, 0.3 * k);
    }
    EXPECT_TRUE(delaunay(line).triangles.empty());
    EXPECT_TRUE(delaunay(std::vector<glm::dvec2>(5, {1, 2})).triangles.empty());
    EXPECT_TRUE(delaunay(std::vector<glm::dvec2>{{1, 2}, {3, 4}}).triangles.empty());
    EXPECT_TRUE(delaunay({}).triangles.empty());
    const auto twice = delaunay(std::vector<glm::dvec2>{{0, 0}, {1, 0}, {0, 0}, {0, 1}});
    EXPECT_THAT(twice.place, testing::ElementsAre(0, 1, 0, 3));
    EXPECT_THAT(twice.triangles, testing::ElementsAre(glm::uvec3(0, 1, 3)));
}

Points points_of(const std::filesystem::path& file) {
    Points points;
    points.file = file;
    points.unit = 1e-3;
    points.centre = false;
    return points;
}

Mesh mesh_of(const Points& points) {
    return std::get<Mesh>(make({.shape = points}).geometry);
}

std::string refusal_of(const Points& points) {
    try {
        make({.shape = points});
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

// Linear interpolation over a triangle is off by at most M R^2 / 2: M bounds the second derivative in any direction, R
// is the radius of the smallest circle that holds the triangle (S. Waldron, SIAM J. Numer. Anal. 35 (1998) 1191); where
// it is obtuse, by h^2 M / 8 with the longest side h.
TEST_F(ScatteredPoints, SurfaceIsThatOfThePointsWithinTheInterpolationsBound) {
    constexpr double amplitude = 2, period = 40; // um
    const auto height = [](const glm::dvec2& p) {
        return amplitude * std::cos(2 * pi * p.x / period) * std::cos(2 * pi * p.y / period);
    };
    // With a = 2 pi x / period, and b alike, the second derivative along (u, v) is at most |cos a cos b| + 2 |u v sin a
    // sin b| <= 1 times this.
    const double curvature = amplitude * std::pow(2 * pi / period, 2);
    auto places = random_points(1500, 7); // within +-50 um
    std::string text = "x y z\n";
    for (glm::dvec2& place : places) {
        place *= 50.0;
        text += fmt::format("{} {} {}\n", place.x, place.y, height(place));
    }
    double radius = 0; // radius of the largest of these circles
    for (const glm::uvec3& t : delaunay(places).triangles) {
        const glm::dvec2 corners[3] = {places[t.x], places[t.y], places[t.z]};
        double longest = 0, others = 0;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec2 side = corners[(k + 1) % 3] - corners[k];
            longest = std::max(longest, glm::dot(side, side));
            others += glm::dot(side, side);
        }
        const bool obtuse = others - longest <= longest;
        const auto is_inside = [](const glm::dvec2& corner) {
            return std::max(std::abs(corner.x), std::abs(corner.y)) < 45;
        };
        if (std::ranges::all_of(corners, is_inside)) { // leaves out the long triangles of the border
            radius = std::max(radius, obtuse ? 0.5 * std::sqrt(longest)
                                             : circle_through(corners[0], corners[1], corners[2]).radius);
        }
    }
    const double bound = 0.5 * curvature * radius * radius;
    ASSERT_LT(bound, 0.5 * amplitude);
    const Specimen specimen = make({.shape = points_of(write("waves.txt", text))});
    double largest = 0, largest_of_twin = 0;
    for (const glm::dvec2& p : random_points(400, 8)) {
        const glm::dvec2 place = 40.0 * p; // well within
        const double seen = truth(specimen, 1, 1, 1e-3 * place.x, 1e-3 * place.y, 1e-9, 1e-9).height(0, 0) * 1e3;
        largest = std::max(largest, std::abs(seen - height(place)));
        largest_of_twin = std::max(largest_of_twin, std::abs(seen - height({place.y, place.x + 5})));
    }
    EXPECT_LE(largest, bound + 1e-4); // the second term allows for rounding to float
    EXPECT_GT(largest, 0.02 * bound);
    EXPECT_GT(largest_of_twin, bound); // wrong twin: turned and moved by an eighth of the period
}

TEST_F(ScatteredPoints, AreReadAsProgramsWriteThem) {
    const std::vector<std::pair<const char*, std::string>> files = {
        {"commas.csv", "x,y,z\n0,0,1\n10,0,2\n0,10,3\n10,10.5,NaN\n"},
        {"semicolons.csv", "\xEF\xBB\xBFX;Y;Z\r\n0;0;1,0\r\n10;0;2,0\r\n0;10,0;3,0\r\n10;10,5;NaN\r\n"},
        {"blanks.xyz", "# from a scanner\n  0  0  1\n 10  0  2\n  0 10  3\n 10 10 bad\n"},
        {"colours.xyz", "0 0 1 255 0 0\n10 0 2 0 255 0\n0 10 3 0 0 255\n- 10 4 0 0 0\n"},
        {"tabs.txt", "0\t0\t1\n10\t0\t2\n0\t10\t3\n0\t10\tBAD\n"},
    };
    for (const auto& [name, text] : files) {
        const FilePoints read = read_points(write(name, text), {});
        EXPECT_THAT(read.points, testing::ElementsAre(glm::dvec3(0, 0, 1), glm::dvec3(10, 0, 2), glm::dvec3(0, 10, 3)))
            << name;
        EXPECT_EQ(read.not_measured, 1u) << name;
    }
}

TEST_F(ScatteredPoints, OneAtThePlaceOfAnotherIsAveragedWithIt) {
    const Mesh mesh = mesh_of(points_of(write("a.csv", "0,0,1\n10,0,0\n0,0,2\n0,10,0\n0,0,6\n")));
    ASSERT_EQ(mesh.triangles.size(), 1u);
    ASSERT_EQ(mesh.vertices.size(), 3u);
    EXPECT_FLOAT_EQ(mesh.vertices[mesh.triangles[0].x].z, 3e-3f);
}

TEST_F(ScatteredPoints, HeightsMayHaveAUnitOfTheirOwn) {
    Points points = points_of(write("a.csv", "0,0,1\n10,0,2\n0,10,3\n"));
    points.unit = 1;
    points.height_unit = 1e-3;
    EXPECT_EQ(mesh_of(points).vertices, (std::vector<glm::vec3>{{0, 0, 1e-3f}, {10, 0, 2e-3f}, {0, 10, 3e-3f}}));
}

// The points are a square frame around nothing.
TEST_F(ScatteredPoints, TrianglesWithLongEdgesAreLeftOut) {
    std::string text;
    for (int i = -10; i <= 10; ++i) {
        for (int j = -10; j <= 10; ++j) {
            if (std::max(std::abs(i), std::abs(j)) > 5) {
                text += fmt::format("{} {} 1\n", i, j);
            }
        }
    }
    text += "500 0 1\n"; // astray: no triangle has it, and it does not widen the specimen
    Points points = points_of(write("frame.xyz", text));
    points.longest_edge = 1.5e-3;
    const Specimen specimen = make({.shape = points});
    const auto height = [&](double x, double y) { return truth(specimen, 1, 1, x, y, 1e-6, 1e-6).height(0, 0); };
    EXPECT_FLOAT_EQ(static_cast<float>(height(0.007, 0.0015)), 1e-3f);
    EXPECT_TRUE(std::isnan(height(0, 0)));
    EXPECT_FLOAT_EQ(static_cast<float>(record(specimen, 1).x_max), 0.01f);
    points.longest_edge = 0;
    EXPECT_FALSE(std::isnan(truth(make({.shape = points}), 1, 1, 0, 0, 1e-6, 1e-6).height(0, 0)));
    points.longest_edge = 0.5e-3;
    EXPECT_THAT(refusal_of(points),
                testing::AllOf(HasSubstr("specimen.longest_edge_um = 0.5"), HasSubstr("triangles")));
}

TEST_F(ScatteredPoints, UnitsInTheNamesOfColumnsAndMarksAreUsed) {
    const std::string lines = "0,0,1\n0.01,0,2\n0,0.01,3\n0.01,0.01,4\n";
    const auto read = [&](const std::string& header, const std::string& more) {
        return parse_points(header + lines + more, "p.csv");
    };
    const FilePoints plain = read("", "0.02,0,1.70141e38\n");
    EXPECT_EQ(plain.points.size(), 4u);
    EXPECT_EQ(plain.not_measured, 1u);
    EXPECT_FALSE(plain.units[0]);
    const FilePoints stated = read("Missing value: -9999\nx [mm],y [mm],z (\xc2\xb5m)\n", "0.02,0,-9999\n");
    EXPECT_EQ(stated.points.size(), 4u);
    EXPECT_EQ(stated.not_measured, 1u);
    EXPECT_EQ(stated.units[0], 1.0);
    EXPECT_EQ(stated.units[1], 1.0);
    EXPECT_EQ(stated.units[2], 1e-3);
    // The file's units hold, whatever the configuration says.
    for (const double unit : {1.0, 1e-3, 25.4}) {
        Points points = points_of(write("stated.csv", "x [mm],y [mm],z [um]\n" + lines));
        points.unit = unit;
        const Specimen specimen = make({.shape = points});
        EXPECT_NEAR(record(specimen, 1).x_max - record(specimen, 1).x_min, 0.01, 1e-8) << unit;
        const auto heights = truth(specimen, 1, 1, 0.0049, 0.0049, 1e-6, 1e-6).height;
        EXPECT_NEAR(heights(0, 0), 1e-3 + 0.1 * 0.0049 + 0.2 * 0.0049, 1e-7)
            << unit; // the height of the plane through the points
    }
}

TEST_F(ScatteredPoints, DamageIsNamed) {
    const std::vector<std::tuple<const char*, std::string, std::vector<std::string>>> cases = {
        {"empty.csv", "", {"empty.csv", "no line of numbers", "x, y and z"}},
        {"two.csv", "0,1\n2,3\n", {"two.csv: points = lines of 2 numbers", "surface"}},
        {"matrix.txt", "1 2 3 4 5 6 7 8 9 10 11 12 13\n", {"lines of 13 numbers", "kind = \"surface\""}},
        {"ragged.csv", "0,0,1\n1,0\n", {"ragged.csv:2", "columns = 2", "3, as in the lines above"}},
        {"word.csv", "0,0,1\n1,0,2x3\n", {"word.csv:2", "column 3 = 2x3", "a number"}},
        {"gaps.csv", "0,0,NaN\n1,NaN,2\n", {"2 lines, each with a gap"}},
        {"line.csv", "0,0,1\n1,1,2\n2,2,5\n", {"3 points, all on a line"}},
        {"far.csv", "0,0,1\n1,0,1\n0,1,1\n1,1,1\n2,1e300,1\n", {"3 of 5 points", "x = 2, y = 1e+300"}},
        {"nul.csv", std::string("0,0,1\n\0,0,1\n", 12), {"nul.csv@6", "a NUL"}},
    };
    for (const auto& [name, text, message] : cases) {
        const std::string found = refusal_of(points_of(write(name, text)));
        for (const std::string& part : message) {
            EXPECT_THAT(found, HasSubstr(part)) << name;
        }
    }
}

} // namespace
} // namespace vkfv::specimen
