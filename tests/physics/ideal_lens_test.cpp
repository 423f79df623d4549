#include "physics/physics.hpp"

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

using namespace vkfv::physics::f64;

namespace {

constexpr double focal_length = 10; // mm
constexpr double immersion = 1.33;

// Passes the lens from a place in front of it, given from its principal planes, with direction cosines (l, m) times the
// index.
IdealLens pass(real3 position, double l, double m, double before, double after, double f = focal_length) {
    return pass_ideal_lens(position, real3(l, m, std::sqrt(before * before - l * l - m * m)), 1 / f, before, after);
}

constexpr std::array<double, 7> sines = {-0.95, -0.6, -0.2, 0.0, 0.3, 0.7, 0.95};

} // namespace

// A point of the front focal plane becomes one plane wave at any aperture: one direction, one optical path to a
// wavefront.
TEST(IdealLens, ImagesItsFrontFocalPlaneToInfinity) {
    for (const auto& [before, after] : {std::pair(1.0, 1.0), {immersion, 1.0}, {1.0, immersion}}) {
        for (const double x : {0.0, 1.5, -4.0}) {
            for (const double l : sines) {
                for (const double m : {0.0, 0.25}) {
                    const IdealLens lens =
                        pass({x, 0.5, -before * focal_length}, before * l, before * m, before, after);
                    ASSERT_EQ(lens.passes, 1u);
                    // The chief ray goes through the nodal point with a slope whose sine is x / f.
                    EXPECT_NEAR(lens.direction.x, -x / focal_length, 1e-15);
                    EXPECT_NEAR(lens.direction.y, -0.05, 1e-15);
                    EXPECT_NEAR(glm::length(lens.direction), after, 1e-15);
                    const real3 from_focus = lens.position - real3(0, 0, after * focal_length);
                    const double wavefront = lens.path_length - glm::dot(lens.direction, from_focus);
                    EXPECT_NEAR(wavefront, focal_length * (before * before + after * after), 1e-13);
                }
            }
        }
    }
}

// By Abbe's sine condition a ray from the focal point leaves at the height n f sin(theta); f tan(theta) is the wrong
// twin.
TEST(IdealLens, ObeysTheSineCondition) {
    for (const double sine : sines) {
        const IdealLens lens = pass({0, 0, -immersion * focal_length}, immersion * sine, 0, immersion, 1);
        EXPECT_NEAR(lens.position.x, immersion * focal_length * sine, 1e-14);
        EXPECT_EQ(lens.direction.x, 0);
        const double tangent = immersion * focal_length * sine / std::sqrt(1 - sine * sine);
        EXPECT_EQ(std::abs(lens.position.x - tangent) > 0.1, std::abs(sine) > 0.25);
    }
}

// Through objective and tube lens all rays of a point meet in one point, along equal optical paths, wherever the tube
// lens stands.
TEST(IdealLens, TwoOfThemImageAPointToAPoint) {
    constexpr double tube = 200;
    for (const double distance : {30.0, 170.0}) {
        double spread = 0; // on a detector 1 um off: the wrong twin
        std::optional<double> path;
        for (const double l : sines) {
            const IdealLens first = pass({0.4, -0.3, -immersion * focal_length}, immersion * l, 0.2, immersion, 1);
            const IdealLens second =
                pass_ideal_lens(first.position - real3(0, 0, distance), first.direction, 1 / tube, 1, 1);
            EXPECT_NEAR(second.position.x, -0.4 * tube / focal_length, 1e-12);
            EXPECT_NEAR(second.position.y, 0.3 * tube / focal_length, 1e-12);
            EXPECT_EQ(second.position.z, tube);
            path = path.value_or(first.path_length + second.path_length);
            EXPECT_NEAR(first.path_length + second.path_length, *path, 1e-12);
            const double here = second.position.x + 0.001 * second.direction.x / second.direction.z;
            spread = std::max(spread, std::abs(here + 8));
        }
        EXPECT_GT(spread, 1e-6);
    }
}

// The map of (x, y, p, q) from one plane to another has the determinant 1 between any planes: etendue is kept. A thin
// lens of tangents is the wrong twin.
TEST(IdealLens, KeepsEtendue) {
    const auto canonical = [](std::array<double, 4> in, bool tangents) {
        const double axial = std::sqrt(immersion * immersion - in[2] * in[2] - in[3] * in[3]);
        const real3 start(in[0], in[1], -12.0); // near the front focal plane, where steep rays pass
        if (tangents) {
            const double x = in[0] + 12 * in[2] / axial;
            const double y = in[1] + 12 * in[3] / axial;
            const real3 slope =
                glm::normalize(real3(in[2] / axial - x / focal_length, in[3] / axial - y / focal_length, 1));
            return std::array{x, y, slope.x, slope.y};
        }
        const IdealLens lens = pass_ideal_lens(start, real3(in[2], in[3], axial), 1 / focal_length, immersion, 1);
        const double on = (4 - lens.position.z) / lens.direction.z;
        return std::array{lens.position.x + on * lens.direction.x, lens.position.y + on * lens.direction.y,
                          lens.direction.x, lens.direction.y};
    };
    const auto determinant = [&](std::array<double, 4> at, bool tangents) {
        constexpr double step = 1e-4;
        glm::dmat4 jacobian;
        for (int i = 0; i < 4; ++i) {
            auto low = at;
            auto high = at;
            low[static_cast<std::size_t>(i)] -= step;
            high[static_cast<std::size_t>(i)] += step;
            const auto from = canonical(low, tangents);
            const auto to = canonical(high, tangents);
            for (int j = 0; j < 4; ++j) {
                jacobian[i][j] = (to[static_cast<std::size_t>(j)] - from[static_cast<std::size_t>(j)]) / (2 * step);
            }
        }
        return glm::determinant(jacobian);
    };
    for (const std::array<double, 4> at :
         {std::array{0.0, 0.0, 0.0, 0.0}, {1.0, 0.5, 0.3, -0.2}, {-1.0, 2.0, 0.9, 0.3}, {2.0, 0.0, -1.0, 0.5}}) {
        // Central differences err by step^2 times third derivatives, a few hundred at the steepest.
        EXPECT_NEAR(determinant(at, false), 1, 1e-5);
    }
    EXPECT_GT(std::abs(determinant({-1.0, 2.0, 0.9, 0.3}, true) - 1), 0.05);
}

// Light sent back along a ray returns along it, with the same optical path.
TEST(IdealLens, IsReversible) {
    for (const double l : sines) {
        const real3 start(0.7, -0.2, -12);
        const IdealLens there = pass(start, immersion * l, 0.1, immersion, 1);
        ASSERT_EQ(there.passes, 1u);
        const auto turned = [](real3 v) { return real3(v.x, -v.y, -v.z); }; // half a turn about x
        const IdealLens back =
            pass_ideal_lens(turned(there.position), turned(-there.direction), 1 / focal_length, 1, immersion);
        const real3 position = turned(back.position);
        const real3 direction = -turned(back.direction);
        const double to_start = (start.z - position.z) / direction.z;
        EXPECT_NEAR(glm::length(position + to_start * direction - start), 0, 1e-13);
        EXPECT_NEAR(direction.x, immersion * l, 1e-14);
        EXPECT_NEAR(direction.y, 0.1, 1e-14);
        // Backward from the front focal plane to the start is against the light there.
        EXPECT_NEAR(back.path_length - to_start * immersion * immersion, there.path_length, 1e-12);
    }
}

// A point as far off the axis as its focal length's reach in air sends no light through.
TEST(IdealLens, RefusesWhatHasNoDirectionBehindIt) {
    EXPECT_EQ(pass({9.9, 0, -focal_length}, 0, 0, 1, 1).passes, 1u);
    EXPECT_EQ(pass({10.1, 0, -focal_length}, 0, 0, 1, 1).passes, 0u);
    EXPECT_EQ(pass({10.1, 0, -focal_length}, 0, 0, 1, immersion).passes, 1u);
}
