// Irregular generated specimens have the statistics asked for, and the facets of others are near the continuous
// function.
#include "core/mathematics/fourier.hpp"
#include "specimen/analytic.hpp"
#include "specimen/intersector.hpp"
#include "specimen/kinds.hpp"
#include "specimen/rays.hpp"
#include "specimen/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

namespace vkfv::specimen {
namespace {

using test::over;
using test::RandomRays;
using test::represented;

constexpr double pi = 3.14159265358979323846;

// Student's t of a sample's mean against what is expected.
double t_value(const std::vector<double>& values, double expected) {
    const double n = static_cast<double>(values.size());
    double sum = 0;
    for (const double value : values) {
        sum += value;
    }
    double squares = 0;
    for (const double value : values) {
        squares += (value - sum / n) * (value - sum / n);
    }
    return std::abs(sum / n - expected) / std::sqrt(squares / (n - 1) / n);
}

double mean(const Grid<float>& grid) {
    double sum = 0;
    for (const float value : grid.values) {
        sum += static_cast<double>(value);
    }
    return sum / static_cast<double>(grid.values.size());
}

double rms(const Grid<float>& grid) {
    double sum = 0;
    for (const float value : grid.values) {
        sum += static_cast<double>(value) * static_cast<double>(value);
    }
    return std::sqrt(sum / static_cast<double>(grid.values.size()));
}

double autocorrelation(const Grid<float>& grid, int lag) {
    double sum = 0;
    for (int row = 0; row < grid.rows; ++row) {
        for (int column = 0; column < grid.columns; ++column) { // periodic, as the field is
            sum +=
                static_cast<double>(grid(column, row)) * static_cast<double>(grid((column + lag) % grid.columns, row));
        }
    }
    return sum / static_cast<double>(grid.values.size()) / (rms(grid) * rms(grid));
}

TEST(Rough, HasTheHeightAndTheCorrelationItIsAskedFor) {
    std::vector<double> at_length;
    for (std::uint32_t seed = 1; seed <= 16; ++seed) {
        auto rough = over<Rough>(0.2, 0.001);
        rough.random = {.sq = 0.0007, .correlation_length = 0.005, .seed = seed};
        const HeightField field = std::get<HeightField>(make({.shape = rough}).geometry);
        ASSERT_EQ(field.heights.columns, 201);
        EXPECT_NEAR(rms(field.heights), 0.0007, 1e-9); // exact but for the rounding of heights to float
        EXPECT_NEAR(mean(field.heights), 0, 1e-9);
        at_length.push_back(autocorrelation(field.heights, 5));
    }
    // The autocorrelation is exp(-1) at the correlation length; removing the mean takes pi l^2 / A (1 - exp(-1)) of it.
    // |t| > 4.07 has the probability 1e-3 for 15 degrees of freedom. The wrong twin has a length 10 % greater.
    const double bias = pi * 25.0 / (201.0 * 201.0) * (1 - std::exp(-1.0));
    EXPECT_LT(t_value(at_length, std::exp(-1.0) - bias), 4.07);
    EXPECT_GT(t_value(at_length, std::exp(-1.0 / 1.21)), 4.07);
}

TEST(Roughness, LeavesWhatTheFilterLeavesOfTheNoise) {
    std::vector<double> remaining;
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        const Specimen specimen =
            make({.shape = over<Plane>(0.1, 0.0005), .roughness = Roughness{0.0002, 0.001, 0.0005, seed}});
        remaining.push_back(std::pow(rms(std::get<HeightField>(specimen.geometry).heights), 2));
    }
    // Squares are compared, which are unbiased; 4.44 is the level 1e-3 for 11 degrees of freedom. The wrong twin has a
    // kernel 5 % wider.
    const auto expected = [](double kernel) { return std::pow(0.0002 * 0.0005 / (2 * std::sqrt(pi) * kernel), 2); };
    EXPECT_LT(t_value(remaining, expected(0.001)), 4.44);
    EXPECT_GT(t_value(remaining, expected(0.00105)), 4.44);
}

// The heights are those of a waved lattice, whose mean deviations are known.
TEST(Roughness, IsToldByItsHeights) {
    constexpr int points = 720;
    Grid<double> waves(points, points);
    for (int row = 0; row < points; ++row) {
        for (int column = 0; column < points; ++column) {
            waves(column, row) = 3 + std::sin(2 * pi * 5 * column / points);
        }
    }
    const RoughnessHeights told = roughness_heights(waves);
    EXPECT_NEAR(told.sq, std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(told.sa, 2 / pi, 2e-4);
    EXPECT_NEAR(told.ra, 1 / pi, 2e-4); // the columns are straight
}

TEST(Roughness, IsAsHighAsItIsAskedFor) {
    const auto made = [](const Roughness& roughness) {
        const Specimen specimen = make({.shape = over<Plane>(0.1, 0.0005), .roughness = roughness});
        const auto& field = std::get<HeightField>(specimen.geometry);
        Grid<double> heights(field.heights.columns, field.heights.rows);
        std::ranges::copy(field.heights.values, heights.values.begin());
        return heights;
    };
    Roughness roughness{0, 0.002, 0.0005, 7};
    roughness.sq = 0.0005;
    EXPECT_NEAR(roughness_heights(made(roughness)).sq, 0.0005, 1e-9);
    const Grid<double> by_sq = made(roughness);
    roughness.sq.reset();
    roughness.ra = 0.00005;
    const RoughnessHeights told = roughness_heights(made(roughness));
    EXPECT_NEAR(told.ra, 0.00005, 1e-10);
    // The mean absolute value of normal heights is sqrt(2 / pi) of Sq; rows of 100 um lose little of their own means.
    EXPECT_NEAR(told.sa / told.sq, std::sqrt(2 / pi), 0.02);
    EXPECT_NEAR(told.ra / told.sa, 1, 0.1);
    // The surface by Ra is the surface by Sq at another scale.
    const Grid<double> by_ra = made(roughness);
    const double factor = by_sq.values[0] / by_ra.values[0];
    EXPECT_NEAR(by_sq.values[12345], factor * by_ra.values[12345], 1e-9);
}

TEST(Roughness, HasTheWavelengthsOfItsBandAlone) {
    Roughness roughness{0, 0, 0.0005, 8};
    roughness.sq = 0.0002;
    roughness.shortest = 0.005;
    roughness.longest = 0.02;
    // The plane has 200 points of 0.5 um: a length of small factors, so that the made field is all of the periodic one.
    auto plane = over<Plane>(0.0995, 0.0005);
    const auto power_outside = [&](double shortest, double longest) {
        const Specimen specimen = make({.shape = plane, .roughness = roughness});
        const auto& field = std::get<HeightField>(specimen.geometry);
        EXPECT_EQ(field.heights.columns, 200);
        Grid<std::complex<double>> spectrum(field.heights.columns, field.heights.rows);
        std::ranges::copy(field.heights.values, spectrum.values.begin());
        fourier_transform(spectrum);
        double outside = 0, all = 0;
        for (int row = 0; row < spectrum.rows; ++row) {
            for (int column = 0; column < spectrum.columns; ++column) {
                const double per_mm =
                    std::hypot(fourier_frequency(column, spectrum.columns), fourier_frequency(row, spectrum.rows)) /
                    0.0005;
                const double power = std::norm(spectrum(column, row));
                all += power;
                outside += per_mm * longest < 1 - 1e-9 || per_mm * shortest > 1 + 1e-9 ? power : 0;
            }
        }
        return outside / all;
    };
    EXPECT_LT(power_outside(0.005, 0.02), 1e-8);
    EXPECT_GT(power_outside(0.006, 0.02), 0.1); // wrong twins
    EXPECT_GT(power_outside(0.005, 0.016), 0.01);
    roughness.shortest.reset();
    roughness.kernel = 0.001;
    EXPECT_LT(power_outside(0, 0.02), 1e-8);
}

TEST(Roughness, IsInterpolatedToFinerFacetsAndRefinesCoarserOnes) {
    auto plane = over<Plane>(0.05, 0.0005);
    const auto made = [&] { return make({.shape = plane, .roughness = Roughness{0.0002, 0.002, 0.001, 5}}).geometry; };
    const HeightField fine = std::get<HeightField>(made());
    EXPECT_EQ(fine.heights.columns, 101);
    plane.pitch = 0.001;
    const HeightField same = std::get<HeightField>(made());
    EXPECT_EQ(same.heights.columns, 51);
    for (int i = 0; i < 51; ++i) {
        EXPECT_NEAR(fine.heights(2 * i, 2 * (50 - i)), same.heights(i, 50 - i), 1e-10f);
    }
    plane.pitch = 0.01;
    EXPECT_EQ(std::get<HeightField>(made()).heights.columns, 51);
    // The lattice of the analytic representation has the same points.
    plane.representation = Representation::analytic;
    EXPECT_EQ(std::get<Analytic>(made()).lattice->heights.values, same.heights.values);
}

TEST(Generated, SeedsMakeTheSameOrOtherFields) {
    auto rough = over<Rough>(0.05, 0.001);
    rough.random = {.sq = 0.001, .correlation_length = 0.005, .seed = 1};
    const auto heights = [&] { return std::get<HeightField>(make({.shape = rough}).geometry).heights.values; };
    const auto first = heights();
    EXPECT_EQ(first, heights());
    rough.random.seed = 2;
    EXPECT_NE(first, heights());
}

struct Pair {
    const char* name;
    Shape shape;
    double second_derivative; // largest of the shape, along a cell's edges or its diagonal, 1/mm
};

TEST(Generated, FacetsAndFunctionAreMetAtTheSamePlaces) {
    std::vector<Pair> pairs;
    constexpr double size = 0.1, pitch = 0.0005;
    auto plane = over<Plane>(size, pitch);
    pairs.push_back({"plane", plane, 0});
    plane.tilt_x = 0.3;
    plane.tilt_y = -0.1;
    pairs.push_back({"tilted plane", plane, 0});
    auto step = over<Step>(size, pitch);
    step.height = 0.002;
    step.wall = 0.002; // its kinks lie on lines of the grid
    pairs.push_back({"step", step, 0});
    auto sphere = over<Sphere>(size, pitch);
    sphere.radius = 0.1;
    sphere.height = 0.05; // the rim at 0.087 is outside the footprint's corner at 0.071
    // The second derivative along the meridian is R^2 / (R^2 - r^2)^(3/2).
    pairs.push_back({"sphere", sphere, 0.01 / std::pow(0.01 - 0.005, 1.5)});
    auto sinusoid = over<Sinusoid>(size, pitch);
    sinusoid.amplitude = 0.001;
    sinusoid.period = 0.02;
    pairs.push_back({"sinusoid", sinusoid, 0.001 * std::pow(2 * pi / 0.02, 2)});
    auto chirp = over<Chirp>(size, pitch);
    chirp.amplitude = 0.001;
    chirp.period = 0.04;
    chirp.period_stop = 0.015;
    // The second derivative is at most A (w^2 + w'), the frequency rising by (1/0.015 - 1/0.04) over 0.1 mm.
    pairs.push_back({"chirp", chirp, 0.001 * (std::pow(2 * pi / 0.015, 2) + 2 * pi * (1 / 0.015 - 1 / 0.04) / 0.1)});
    RandomRays random(7);
    for (const Pair& pair : pairs) {
        const Intersector on_facets(make({.shape = represented(pair.shape, Representation::facets)}));
        const Specimen continuous = make({.shape = represented(pair.shape, Representation::analytic)});
        const Intersector on_function(continuous);
        const auto r = record(continuous, 1);
        // Linear interpolation in a triangle is off by h'' / 8 of the square of its longest edge (the diagonal; for
        // shapes along x its extent in x is the pitch, which is less). Heights are also rounded to float.
        const double between = pair.second_derivative * 2 * pitch * pitch / 8 + 6e-8 * std::max(-r.bottom, r.top);
        int compared = 0;
        for (int i = 0; i < 3000; ++i) {
            const glm::dvec3 direction = -random.direction(0, 0.5);
            const glm::dvec3 origin =
                glm::dvec3(random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04), 0) - 0.3 * direction;
            const auto a = on_facets.hit(origin, direction);
            const auto b = on_function.hit(origin, direction);
            const double approach = -direction.z - r.lipschitz * std::hypot(direction.x, direction.y);
            const glm::dvec3 level = origin + 0.3 * direction;
            if (std::max(std::abs(level.x), std::abs(level.y)) > 0.04 || approach < 0.2) {
                continue; // beside the footprint, or where a facet may hide what the function shows
            }
            ASSERT_EQ(a.found, b.found) << pair.name;
            if (a.found == 1u) {
                ++compared;
                // The tolerance is the gap between the two surfaces, as far as the ray stretches it, and rounding of
                // the distance.
                EXPECT_NEAR(a.distance, b.distance, between / approach + 1e-13) << pair.name;
            }
        }
        EXPECT_GT(compared, 300) << pair.name;
    }
}

TEST(Generated, FacetsAndLatticeOfARoughSurfaceDifferByTheirInterpolation) {
    auto rough = over<Rough>(0.1, 0.0005);
    rough.random = {.sq = 0.0005, .correlation_length = 0.01, .seed = 11};
    const Intersector on_facets(make({.shape = rough}));
    rough.representation = Representation::analytic;
    const Intersector on_function(make({.shape = rough}));
    RandomRays random(8);
    double squares = 0;
    int count = 0;
    for (int i = 0; i < 4000; ++i) {
        const glm::dvec3 origin(random.uniform(-0.049, 0.049), random.uniform(-0.049, 0.049), 0.1);
        const auto a = on_facets.hit(origin, {0, 0, -1});
        const auto b = on_function.hit(origin, {0, 0, -1});
        ASSERT_EQ(a.found, 1u);
        ASSERT_EQ(b.found, 1u);
        // The second derivative of such a field in one direction has the standard deviation sqrt(12) sq / l^2; the
        // tolerance is five of these, along the triangle's diagonal.
        EXPECT_NEAR(a.distance, b.distance, 5 * std::sqrt(12.0) * 0.0005 / 1e-4 * 2 * 0.0005 * 0.0005 / 8);
        squares += (a.distance - b.distance) * (a.distance - b.distance);
        ++count;
    }
    EXPECT_GT(std::sqrt(squares / count), 1e-8) << "the two must not be the same surface";
}

} // namespace
} // namespace vkfv::specimen
