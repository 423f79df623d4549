// The analytic height function and the march agree with closed forms and a plain search.
#include "specimen/analytic.hpp"
#include "specimen/intersector.hpp"
#include "specimen/kinds.hpp"
#include "specimen/rays.hpp"
#include "specimen/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vkfv::specimen {
namespace {

using test::RandomRays;

constexpr double pi = 3.14159265358979323846;
constexpr double infinity = std::numeric_limits<double>::infinity();

physics::f32::SpecimenRecord to_float(const physics::f64::SpecimenRecord& r) {
    physics::f32::SpecimenRecord f{};
    f.x_min = static_cast<float>(r.x_min);
    f.y_min = static_cast<float>(r.y_min);
    f.x_max = static_cast<float>(r.x_max);
    f.y_max = static_cast<float>(r.y_max);
    f.bottom = static_cast<float>(r.bottom);
    f.top = static_cast<float>(r.top);
    f.pitch_x = static_cast<float>(r.pitch_x);
    f.pitch_y = static_cast<float>(r.pitch_y);
    f.shape_parameter_0 = static_cast<float>(r.shape_parameter_0);
    f.shape_parameter_1 = static_cast<float>(r.shape_parameter_1);
    f.shape_parameter_2 = static_cast<float>(r.shape_parameter_2);
    f.shape_parameter_3 = static_cast<float>(r.shape_parameter_3);
    f.lipschitz = static_cast<float>(r.lipschitz);
    f.columns = r.columns;
    f.rows = r.rows;
    f.kind = r.kind;
    f.shape = r.shape;
    return f;
}

struct FloatLattice {
    const HeightField* lattice = nullptr;
    float lattice_at(int column, int row) const { return lattice->heights(column, row); }
};

template <class OneKind>
OneKind analytic(double size = 0.2) {
    auto kind = test::over<OneKind>(size, 0.0005);
    kind.representation = Representation::analytic;
    return kind;
}

Sphere sphere_cap() {
    auto d = analytic<Sphere>();
    d.radius = 0.1;
    d.height = 0.03;
    return d;
}

Rough rough_surface() {
    auto d = analytic<Rough>(0.05);
    d.random = {.sq = 0.001, .correlation_length = 0.004, .seed = 3};
    return d;
}

struct Expected {
    const char* name;
    Shape shape;
    double (*height)(double x, double y);
};

std::vector<Expected> shapes() {
    std::vector<Expected> list;
    auto plane = analytic<Plane>();
    plane.tilt_x = 0.1;
    plane.tilt_y = -0.2;
    list.push_back({"plane", plane, [](double x, double y) { return x * std::tan(0.1) - y * std::tan(0.2); }});
    auto step = analytic<Step>();
    step.height = 0.004;
    step.wall = 0.002;
    list.push_back({"step", step, [](double x, double) {
                        return x <= -0.001 ? -0.002 : x >= 0.001 ? 0.002 : -0.002 + 0.004 * (x + 0.001) / 0.002;
                    }});
    list.push_back({"cap", sphere_cap(), [](double x, double y) {
                        const double r2 = x * x + y * y;
                        return r2 < 0.01 ? std::max(std::sqrt(0.01 - r2) - 0.07, 0.0) : 0.0;
                    }});
    Sphere dimple = sphere_cap();
    dimple.height = -0.02;
    list.push_back({"dimple", dimple, [](double x, double y) {
                        const double r2 = x * x + y * y;
                        return r2 < 0.01 ? std::min(0.08 - std::sqrt(0.01 - r2), 0.0) : 0.0;
                    }});
    auto sinusoid = analytic<Sinusoid>();
    sinusoid.amplitude = 0.001;
    sinusoid.period = 0.013;
    list.push_back({"sinusoid", sinusoid, [](double x, double) { return 0.001 * std::sin(2 * pi * x / 0.013); }});
    auto chirp = analytic<Chirp>();
    chirp.amplitude = 0.001;
    chirp.period = 0.04;
    chirp.period_stop = 0.01;
    list.push_back({"chirp", chirp, [](double x, double) {
                        // The phase is the integral of a frequency that goes from 25 to 100 per mm over 0.2 mm.
                        const double s = x + 0.1;
                        return 0.001 * std::sin(2 * pi * (25 * s + 0.5 * 375 * s * s));
                    }});
    return list;
}

TEST(SurfaceFunction, HeightsOfEveryShapeAreTheClosedForms) {
    RandomRays random(1);
    for (const Expected& one : shapes()) {
        const Specimen specimen = make({.shape = one.shape});
        const auto r = record(specimen, 1);
        const auto f = to_float(r);
        for (int i = 0; i < 2000; ++i) {
            const double x = random.uniform(-0.1, 0.1);
            const double y = random.uniform(-0.1, 0.1);
            const double expected = one.height(x, y);
            const auto found = physics::f64::shape_height(r, x, y);
            // Heights up to 0.04 mm come of terms up to 0.1 mm: some roundings of 2^-53 of 0.1, and a sine of up to 12
            // turns.
            EXPECT_NEAR(found.height, expected, 1e-16) << one.name << " at " << x << ", " << y;
            EXPECT_LE(std::hypot(found.slope_x, found.slope_y), r.lipschitz);
            EXPECT_GE(found.height, r.bottom);
            EXPECT_LE(found.height, r.top);
            // In float x is wrong by 2^-24 of 0.1, which the slope passes on, and the sum by some more.
            const double tolerance = 6e-8 * (0.1 + 4 * 0.2 * r.lipschitz);
            const auto in_float = physics::f32::shape_height(f, static_cast<float>(x), static_cast<float>(y));
            EXPECT_NEAR(static_cast<double>(in_float.height), expected, tolerance) << one.name;
        }
    }
}

TEST(SurfaceFunction, SlopesAreTheDerivatives) {
    RandomRays random(2);
    std::vector<Shape> all{rough_surface()};
    for (const Expected& one : shapes()) {
        all.push_back(one.shape);
    }
    for (const Shape& shape : all) {
        const Specimen specimen = make({.shape = shape});
        const auto r = record(specimen, 1);
        const Analytic& geometry = std::get<Analytic>(specimen.geometry);
        const LatticeScene scene{geometry.lattice ? &*geometry.lattice : nullptr};
        const double half = 0.499 * size_of(shape);
        const double h = 1e-7;
        int kinks = 0;
        for (int i = 0; i < 1000; ++i) {
            const double x = random.uniform(-half, half);
            const double y = random.uniform(-half, half);
            const auto at = [&](double dx, double dy) {
                return physics::f64::surface_height(scene, r, x + dx, y + dy).height;
            };
            const auto found = physics::f64::surface_height(scene, r, x, y);
            // Central differences err by h^2/6 of the third derivative (below 1e6 mm^-2 here) and 1e-17 / h of
            // rounding. A kink (flank, rim) within h of the point is hit by no more than one in 10000.
            const bool close = std::abs((at(h, 0) - at(-h, 0)) / (2 * h) - found.slope_x) < 1e-7 &&
                               std::abs((at(0, h) - at(0, -h)) / (2 * h) - found.slope_y) < 1e-7;
            kinks += close ? 0 : 1;
        }
        EXPECT_LE(kinks, 1);
    }
}

TEST(SurfaceFunction, ChirpHasTheNumberOfPeriodsOfALinearSweep) {
    auto d = analytic<Chirp>();
    d.amplitude = 0.001;
    d.period = 0.04;
    d.period_stop = 0.01;
    const auto r = record(make({.shape = d}), 1);
    int crossings = 0;
    double before = physics::f64::shape_height(r, -0.1 + 1e-6, 0).height;
    for (double x = -0.1 + 2e-6; x < 0.1 - 1e-6; x += 1e-6) {
        const double now = physics::f64::shape_height(r, x, 0).height;
        crossings += (now < 0) != (before < 0) ? 1 : 0;
        before = now;
    }
    // The mean of 25 and 100 periods per mm over 0.2 mm makes 12.5 periods, whose zeros inside are 24. A sweep linear
    // in the period would have 0.2 / 0.03 ln 4 = 9.24.
    EXPECT_EQ(crossings, 24);
}

TEST(SurfaceFunction, LatticeIsInterpolatedWithContinuousSlopeWithinItsBounds) {
    const Specimen specimen = make({.shape = rough_surface()});
    const auto r = record(specimen, 1);
    const HeightField& lattice = *std::get<Analytic>(specimen.geometry).lattice;
    const LatticeScene scene{&lattice};
    const FloatLattice float_scene{&lattice};
    const auto f = to_float(r);
    for (int row = 0; row < lattice.heights.rows; row += 7) {
        for (int column = 0; column < lattice.heights.columns; ++column) {
            const double x = lattice.x_min + column * lattice.pitch_x;
            const double y = lattice.y_min + row * lattice.pitch_y;
            // The place in the lattice is wrong by some 2^-53 of 0.05 mm / 0.0005 mm, times a slope below 2.
            EXPECT_NEAR(physics::f64::surface_height(scene, r, x, y).height,
                        static_cast<double>(lattice.heights(column, row)), 1e-15);
        }
    }
    RandomRays random(3);
    double steepest = 0;
    double highest = -1;
    for (int i = 0; i < 20000; ++i) {
        const double x = random.uniform(-0.025, 0.025);
        const double y = random.uniform(-0.025, 0.025);
        const auto found = physics::f64::surface_height(scene, r, x, y);
        steepest = std::max(steepest, std::hypot(found.slope_x, found.slope_y));
        highest = std::max(highest, found.height);
        EXPECT_GT(found.height, r.bottom);
        const auto in_float =
            physics::f32::surface_height(float_scene, f, static_cast<float>(x), static_cast<float>(y));
        EXPECT_NEAR(static_cast<double>(in_float.height), found.height, 6e-8 * 0.2 * r.lipschitz);
        // The two points lie on either side of a line of the lattice.
        const double line = lattice.x_min + (1 + i % (lattice.heights.columns - 2)) * lattice.pitch_x;
        const auto left = physics::f64::surface_height(scene, r, line - 1e-12, y);
        const auto right = physics::f64::surface_height(scene, r, line + 1e-12, y);
        // The tolerance is for 2e-12 mm times a second derivative below 1e4 / mm.
        EXPECT_NEAR(left.slope_x, right.slope_x, 1e-7);
        EXPECT_NEAR(left.slope_y, right.slope_y, 1e-7);
    }
    EXPECT_LE(steepest, r.lipschitz);
    EXPECT_GE(steepest, 0.4 * r.lipschitz) << "the bound must bound, but not by far";
    EXPECT_LE(highest, r.top);
}

TEST(March, MeetsASphereWhereTheClosedFormDoes) {
    const Specimen specimen = make({.shape = sphere_cap()});
    const auto r = record(specimen, 1);
    const auto f = to_float(r);
    const Intersector intersector(specimen);
    const FloatLattice no_lattice;
    RandomRays random(4);
    int on_cap = 0;
    for (int i = 0; i < 5000; ++i) {
        // The ray goes towards a point of the cap's neighbourhood, from above, up to 80 degrees off the normal.
        const glm::dvec3 target(random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08), 0);
        const glm::dvec3 direction = -random.direction(0, 1.4);
        const glm::dvec3 origin = target - direction * ((r.top - target.z) / -direction.z);
        if (std::abs(origin.x) > 0.1 || std::abs(origin.y) > 0.1) {
            continue; // through the side of the footprint
        }
        // The cap's sphere has its centre at z = 0.03 - 0.1; the plane around is at z = 0.
        const glm::dvec3 from_centre = origin - glm::dvec3(0, 0, -0.07);
        const double b = glm::dot(from_centre, direction);
        const double discriminant = b * b - glm::dot(from_centre, from_centre) + 0.01;
        double distance = -origin.z / direction.z;
        bool cap = false;
        if (discriminant > 0) {
            const double to_sphere = -b - std::sqrt(discriminant);
            if (origin.z + to_sphere * direction.z > 0) {
                distance = to_sphere;
                cap = true;
            }
        }
        const bool grazing = std::abs(discriminant) < 1e-6;
        const auto hit = intersector.hit(origin, direction);
        ASSERT_EQ(hit.found, 1u);
        if (grazing) {
            continue; // the closed form itself loses its digits
        }
        on_cap += cap ? 1 : 0;
        // The tolerance is a residual of some 1e-16 mm in height over the least rate of approach, here above 1e-3
        // (discriminant and angle).
        EXPECT_NEAR(hit.distance, distance, 1e-12);
        const glm::dvec3 point = origin + distance * direction;
        EXPECT_NEAR(glm::length(hit.position - point), 0, 1e-12);
        const glm::dvec3 normal = cap ? (point - glm::dvec3(0, 0, -0.07)) / 0.1 : glm::dvec3(0, 0, 1);
        EXPECT_NEAR(glm::length(hit.normal - normal), 0, 1e-10);
        const auto in_float = physics::f32::march_surface(no_lattice, f, glm::vec3(origin), glm::vec3(direction), 0.0f,
                                                          std::numeric_limits<float>::max());
        ASSERT_EQ(in_float.found, 1u);
        // In float the hit is on the surface to its own rounding: 4 ulp of the coordinates times slope.
        const double x = static_cast<double>(in_float.position.x);
        const double y = static_cast<double>(in_float.position.y);
        EXPECT_NEAR(static_cast<double>(in_float.position.z), physics::f64::shape_height(r, x, y).height,
                    6e-8 * 4 * 0.3 * r.lipschitz);
    }
    EXPECT_GT(on_cap, 500);
}

TEST(March, FindsTheFirstCrossingOfARoughSurface) {
    const Specimen specimen = make({.shape = rough_surface()});
    const auto r = record(specimen, 1);
    const auto f = to_float(r);
    const Intersector intersector(specimen);
    const HeightField& lattice = *std::get<Analytic>(specimen.geometry).lattice;
    const LatticeScene scene{&lattice};
    const FloatLattice float_scene{&lattice};
    RandomRays random(5);
    int met = 0;
    int floats_beside = 0;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 origin(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02), r.top);
        const glm::dvec3 direction = -random.direction(0, 1.5);
        const auto gap = [&](double t) {
            const glm::dvec3 p = origin + t * direction;
            return p.z - physics::f64::surface_height(scene, r, p.x, p.y).height;
        };
        const auto outside = [&](double t) {
            const glm::dvec3 p = origin + t * direction;
            return std::abs(p.x) > 0.025 || std::abs(p.y) > 0.025;
        };
        // The truth is a plain search in steps of 0.02 um and bisection.
        double t = 0;
        while (!outside(t) && gap(t) > 0) {
            t += 2e-5;
        }
        const bool expected = !outside(t);
        double lower = t - 2e-5;
        double upper = t;
        for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (lower + upper);
            (gap(middle) > 0 ? lower : upper) = middle;
        }
        const auto hit = intersector.hit(origin, direction);
        const auto in_float = physics::f32::march_surface(float_scene, f, glm::vec3(origin), glm::vec3(direction), 0.0f,
                                                          std::numeric_limits<float>::max());
        if (expected) {
            ++met;
            ASSERT_EQ(hit.found, 1u) << i;
            // The march may find a graze that the search steps over, never a later crossing. The tolerance is a
            // residual of 1e-15 mm over a rate of approach that is below 1e-3 for one ray in hundreds.
            EXPECT_LE(hit.distance, upper + 1e-11) << i;
            EXPECT_NEAR(gap(hit.distance), 0, 2e-15) << i;
            EXPECT_GT(hit.distance, upper - 2e-3) << i;
        }
        floats_beside += in_float.found == hit.found ? 0 : 1;
        if (in_float.found == 1u && hit.found == 1u) {
            EXPECT_NEAR(static_cast<double>(in_float.position.z),
                        physics::f64::surface_height(scene, r, static_cast<double>(in_float.position.x),
                                                     static_cast<double>(in_float.position.y))
                            .height,
                        6e-8 * 0.2 * r.lipschitz);
        }
    }
    EXPECT_GT(met, 200);
    EXPECT_LE(floats_beside, 1); // at the footprint's border
}

// Light that leaves a convex surface never meets it again, whatever the direction: rays are neither stuck nor leaked.
template <class Real, class Record, class March>
int meetings_after_leaving(const Record& r, March march, double offset) {
    RandomRays random(6);
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        const double angle = random.uniform(0, 6.28);
        const double rho = random.uniform(0, 0.06); // the cap's rim is at 0.0714
        const double x = rho * std::cos(angle);
        const double y = rho * std::sin(angle);
        const double z = 0.03 - (x * x + y * y) / (0.1 + std::sqrt(0.01 - x * x - y * y));
        const glm::dvec3 normal = glm::normalize(glm::dvec3(x, y, z + 0.07));
        glm::dvec3 direction = random.direction(0, pi);
        direction = glm::dot(direction, normal) < 0 ? -direction : direction;
        if (i % 4 == 0) { // tangential, but for a little
            direction = glm::normalize(direction - (1 - 1e-4) * glm::dot(direction, normal) * normal);
        }
        if (direction.z < -0.1) {
            continue; // may reach the plane around the cap
        }
        const glm::dvec3 origin = glm::dvec3(x, y, z) + offset * 0.1 * normal;
        const auto hit = march(r, glm::vec<3, Real>(origin), glm::vec<3, Real>(direction));
        // A shallow descent may end on the plane, but then far away.
        met += hit.found == 1u && direction.z >= 0 ? 1 : 0;
        if (hit.found == 1u && direction.z < 0) {
            met += hit.distance < Real(1e-3) ? 1 : 0;
        }
    }
    return met;
}

TEST(March, LetsGoOfAConvexSurface) {
    const auto r = record(make({.shape = sphere_cap()}), 1);
    const auto f = to_float(r);
    // The offset is that of scatter_origin in path.glsl: 2^-20 of the largest coordinate.
    EXPECT_EQ(0, meetings_after_leaving<float>(
                     f,
                     [](const auto& record, glm::vec3 origin, glm::vec3 direction) {
                         return physics::f32::march_surface(FloatLattice{}, record, origin, direction, 0.0f,
                                                            std::numeric_limits<float>::max());
                     },
                     0x1p-20));
    EXPECT_EQ(0, meetings_after_leaving<double>(
                     r,
                     [](const auto& record, glm::dvec3 origin, glm::dvec3 direction) {
                         return physics::f64::march_surface(LatticeScene{}, record, origin, direction, 0.0, infinity);
                     },
                     0x1p-20));
    // The wrong twin: a start below the surface by 10 nm is met, every time.
    EXPECT_LT(10000, meetings_after_leaving<double>(
                         r,
                         [](const auto& record, glm::dvec3 origin, glm::dvec3 direction) {
                             return physics::f64::march_surface(LatticeScene{}, record, origin, direction, 0.0,
                                                                infinity);
                         },
                         -1e-4));
}

TEST(March, StartBelowIsMetAtOnceAndEntryBelowFromBelow) {
    auto d = analytic<Sinusoid>();
    d.amplitude = 0.002;
    d.period = 0.05;
    const auto r = record(make({.shape = d}), 1);
    const auto march = [&](glm::dvec3 origin, glm::dvec3 direction) {
        return physics::f64::march_surface(LatticeScene{}, r, origin, glm::normalize(direction), 0.0, infinity);
    };
    const auto below = march({0.0125, 0, 0.001}, {0, 0, 1}); // the crest there is at 0.002
    EXPECT_EQ(below.found, 1u);
    EXPECT_EQ(below.distance, 0.0);
    EXPECT_NEAR(below.position.z, 0.002, 1e-15);
    // The ray comes from the side at half height: x = -0.1 is a zero crossing (4 half periods), rising; the ray at
    // -0.001 is below until the surface falls to it: sin = -1/2 first at x = -0.075 + 0.05 / 12.
    const auto side = march({-0.2, 0, -0.001}, {1, 0, 0});
    EXPECT_EQ(side.found, 1u);
    EXPECT_NEAR(side.position.x, -0.075 + 0.05 / 12, 1e-12);
    EXPECT_GT(side.normal.z, 0);
    EXPECT_EQ(march({0, 0, 0.01}, {0, 0, 1}).found, 0u);
    EXPECT_EQ(march({0.2, 0, 0.01}, {0, 0, -1}).found, 0u);
    EXPECT_EQ(march({0, 0, 0.01}, {1, 0, 0}).found, 0u);
}

TEST(March, MeetsALevelPlaneFromItsTopAndAStepOnItsFlank) {
    auto level = analytic<Plane>();
    const auto plane = record(make({.shape = level}), 1);
    const auto on_plane = physics::f64::march_surface(LatticeScene{}, plane, glm::dvec3(0.01, 0, plane.top),
                                                      glm::dvec3(0, 0, -1), 0.0, infinity);
    EXPECT_EQ(on_plane.found, 1u);
    EXPECT_EQ(on_plane.position.z, 0.0);
    const auto in_float =
        physics::f32::march_surface(FloatLattice{}, to_float(plane), glm::vec3(0.01f, 0, static_cast<float>(plane.top)),
                                    glm::vec3(0, 0, -1), 0.0f, 1e30f);
    EXPECT_EQ(in_float.found, 1u);

    auto d = analytic<Step>();
    d.height = 0.004;
    d.wall = 0.001;
    const auto step = record(make({.shape = d}), 1);
    EXPECT_NEAR(step.lipschitz, 4, 1e-5);
    // Level rays from the low side meet the flank z = 4 x at their own height.
    for (const double z : {-0.0015, 0.0, 0.001, 0.0019}) {
        const auto hit = physics::f64::march_surface(LatticeScene{}, step, glm::dvec3(-0.05, 0.01, z),
                                                     glm::dvec3(1, 0, 0), 0.0, infinity);
        ASSERT_EQ(hit.found, 1u) << z;
        EXPECT_NEAR(hit.position.x, z / 4, 1e-15);
        EXPECT_NEAR(hit.normal.x, -4 / std::sqrt(17.0), 1e-12);
    }
}

} // namespace
} // namespace vkfv::specimen
