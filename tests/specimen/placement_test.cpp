// A specimen that is placed has the surface, the print and the dimensions of the specimen in the middle, moved.
#include "core/mathematics/units.hpp"
#include "dimensions/evaluate.hpp"
#include "specimen/description.hpp"
#include "specimen/kinds.hpp"
#include "specimen/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace vkfv;
using namespace vkfv::specimen;
using vkfv::test::over;

namespace {

constexpr double degree = radians_per_degree;

// The largest distance of the truth, over 0.2 x 0.2 mm in pixels of 2 um, from a function of x and y.
double farthest_from(const Description& description, const std::function<double(double, double)>& height) {
    const auto map = truth(make(description), 100, 100, -0.099, -0.099, 0.002, 0.002);
    double farthest = 0;
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns(); ++column) {
            const double off = map.height(column, row) - height(map.x(column), map.y(row));
            farthest = std::isfinite(off) ? std::max(farthest, std::abs(off)) : INFINITY;
        }
    }
    return farthest;
}

Sinusoid wave() {
    auto wave = over<Sinusoid>(0.6, 0.001);
    wave.amplitude = 0.001;
    wave.period = 0.08;
    return wave;
}

// Facets of 1 um and pixels of 2 um miss a wave of 80 um by up to (pi 2 / 80)^2 / 6 of its amplitude of 1 um, and
// floats of 0.3 mm by 2e-8 mm a coordinate.
constexpr double of_facets = 2e-6;

TEST(Placement, TurnsAndShiftsHeights) {
    const Placement placement{.shift = {0.013, -0.007, 0.02}, .rotation = 25 * degree};
    const auto turned_by = [&](double angle) {
        return [=](double x, double y) {
            const double u = (x - 0.013) * std::cos(angle) + (y + 0.007) * std::sin(angle);
            return 0.02 + 0.001 * std::sin(2 * pi * u / 0.08);
        };
    };
    EXPECT_LT(farthest_from({.shape = wave(), .placement = placement}, turned_by(25 * degree)), of_facets);
    // The wrong twin turns the other way.
    EXPECT_GT(farthest_from({.shape = wave(), .placement = placement}, turned_by(-25 * degree)), 1e-3);
    // Without a turn the surface stays a height field, which is traced by its pyramid.
    const Placement shift{.shift = {0.013, -0.007, 0.02}};
    EXPECT_LT(farthest_from({.shape = wave(), .placement = shift}, turned_by(0)), of_facets);
    EXPECT_TRUE(std::holds_alternative<HeightField>(make({.shape = wave(), .placement = shift}).geometry));
}

TEST(Placement, TiltsByTheSlopesThatItNames) {
    const Placement placement{
        .shift = {0.01, 0.02, -0.003}, .rotation = 70 * degree, .tilt_x = 10 * degree, .tilt_y = -4 * degree};
    const auto level = over<Plane>(0.6, 0.01);
    const auto plane = [](double sense) {
        return [sense](double x, double y) {
            return -0.003 + std::tan(10 * degree) * (x - 0.01) - sense * std::tan(4 * degree) * (y - 0.02);
        };
    };
    EXPECT_LT(farthest_from({.shape = level, .placement = placement}, plane(1)), 1e-7);
    EXPECT_GT(farthest_from({.shape = level, .placement = placement}, plane(-1)), 1e-3);
    // A turn keeps lengths: its matrix is orthogonal, of determinant 1.
    const glm::dmat3 turn = placement.turn();
    const glm::dmat3 identity = glm::transpose(turn) * turn;
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(glm::length(identity[k] - glm::dmat3(1)[k]), 0, 1e-15);
    }
    EXPECT_NEAR(glm::determinant(turn), 1, 1e-15);
}

TEST(Placement, OfAStandardMovesItsFeature) {
    auto groove = over<Groove>(0.4, 0.0005);
    groove.width = 0.05;
    groove.depth = 0.01;
    groove.wall = 0.002;
    const Description description{
        .shape = groove, .placement = {.shift = {0.02, 0.01, 0.004}, .rotation = 12 * degree, .tilt_x = 0.3 * degree}};
    const auto map = truth(make(description), 150, 150, -0.149, -0.149, 0.002, 0.002);
    const auto found = dimensions::evaluate(map, *feature_of(description));
    ASSERT_FALSE(found.empty());
    for (const auto& one : found) {
        EXPECT_NEAR(one.value, one.nominal, 1e-3 * one.nominal) << one.name;
    }
    // Looked for in the middle, the same groove has another depth.
    const auto astray = dimensions::evaluate(map, *feature_of(description.shape));
    EXPECT_GT(std::abs(astray.front().value - astray.front().nominal), 1e-2 * astray.front().nominal);
}

TEST(Placement, TakesThePrintAlong) {
    Reflectance print{.kind = Reflectance::Kind::grating, .x = 0.003, .y = 0, .angle = 5 * degree, .period = 0.02};
    const auto made =
        make({.shape = wave(), .reflectance = print, .placement = {.shift = {0.01, 0.02, 0}, .rotation = 90 * degree}});
    const auto& record = made.reflectance->record;
    EXPECT_NEAR(record.centre_x, 0.01, 1e-12);
    EXPECT_NEAR(record.centre_y, 0.023, 1e-12);
    EXPECT_NEAR(record.axis_x, std::cos(95 * degree), 1e-12);
    EXPECT_NEAR(record.axis_y, std::sin(95 * degree), 1e-12);
}

TEST(Placement, IsRefusedWhereItCannotBeTraced) {
    auto analytic = wave();
    analytic.representation = Representation::analytic;
    EXPECT_THROW(make({.shape = analytic, .placement = {.shift = {0.001, 0, 0}}}), InputError);
    EXPECT_NO_THROW(make({.shape = analytic, .placement = {}}));
}

} // namespace
