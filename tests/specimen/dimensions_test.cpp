// Standards of ISO 25178-70 have the heights of closed forms, and the dimensions that are found on their truth are
// nominal.
#include "core/mathematics/units.hpp"
#include "dimensions/evaluate.hpp"
#include "specimen/description.hpp"
#include "specimen/kinds.hpp"
#include "specimen/shapes.hpp"
#include "surface/height_parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

using namespace vkfv;
using namespace vkfv::specimen;
using vkfv::test::over;

namespace {

// The truth of a shape over 0.3 x 0.2 mm, with pixels of 2 um.
surface::HeightMap truth_of(const Shape& shape) {
    return truth(make({.shape = shape}), 150, 100, -0.149, -0.099, 0.002, 0.002);
}

std::map<std::string, dimensions::Dimension> dimensions_of(const Shape& shape) {
    std::map<std::string, dimensions::Dimension> named;
    for (const auto& one : dimensions::evaluate(truth_of(shape), *feature_of(shape)))
        named[one.name] = one;
    return named;
}

// Expects that the value is nominal to within a share of it.
void expect_nominal(const std::map<std::string, dimensions::Dimension>& found, const std::string& name, double share) {
    ASSERT_TRUE(found.contains(name)) << name;
    const auto& one = found.at(name);
    EXPECT_NEAR(one.value, one.nominal, share * one.nominal) << name;
}

double sq_of(const Shape& shape) {
    return surface::height_parameters(truth_of(shape)).sq;
}

TEST(StandardsAsSold, RootMeanSquaresAreThoseOfClosedForms) {
    // Whole periods lie in the field; a pixel's mean and the facets take a share of (pi pitch / period)^2 / 6.
    auto wave = over<Sinusoid>(0.32, 0.001);
    wave.amplitude = 0.001;
    wave.period = 0.05;
    EXPECT_NEAR(sq_of(wave), 0.001 / std::sqrt(2), 3e-6);
    auto cross = over<CrossSinusoid>(0.32, 0.001);
    cross.amplitude = 0.0005;
    cross.period = 0.05;
    cross.period_y = 0.04;
    EXPECT_NEAR(sq_of(cross), 0.0005, 3e-6); // two waves of A / sqrt(2)
    auto roof = over<Grating>(0.32, 0.001);
    roof.profile = Grating::Profile::triangular;
    roof.period = 0.05;
    roof.depth = 0.01;
    EXPECT_NEAR(sq_of(roof), 0.01 / std::sqrt(12), 1e-5);
    auto lines = over<Grating>(0.32, 0.001);
    lines.period = 0.05;
    lines.depth = 0.002;
    lines.line_width = 0.02;
    lines.wall = 0.01; // a sixth of each of the two flanks is missing from the mean square
    EXPECT_NEAR(sq_of(lines), 0.002 * std::sqrt(0.4 * 0.6 - 0.2 / 3), 5e-6);
    auto texture = over<Deterministic>(0.32, 0.001);
    texture.period = 0.1;
    texture.sq = 0.0005;
    texture.orders = 8;
    texture.hurst = 0.8;
    EXPECT_NEAR(sq_of(texture), 0.0005, 5e-6);
}

TEST(StandardsAsSold, ADeterministicTextureRepeatsItselfAndHasNoRandomNumber) {
    auto texture = over<Deterministic>(0.32, 0.001);
    texture.period = 0.1;
    texture.sq = 0.0005;
    texture.orders = 3;
    texture.hurst = 0.5;
    const auto map = truth_of(texture);
    EXPECT_NEAR(map.height(20, 30), map.height(70, 80), 1e-9);
    // The rule is written out anew at one point.
    double sum = 0, squares = 0;
    int k = 0;
    for (int m = 0; m <= 3; ++m)
        for (int n = -3; n <= 3; ++n)
            if ((m > 0 || n > 0) && m * m + n * n <= 9) {
                const double c = std::pow(m * m + n * n, -0.75);
                sum += c * std::cos(2 * pi * (++k * 0.6180339887498949));
                squares += c * c / 2;
            }
    const auto made = make({.shape = texture});
    const auto& field = std::get<HeightField>(made.geometry);
    EXPECT_NEAR(static_cast<double>(field.heights(160, 160)), 0.0005 * sum / std::sqrt(squares), 1e-9);
}

TEST(StandardsAsSold, DimensionsOfTheTruthAreNominal) {
    auto step = over<Step>(0.32, 0.001);
    step.height = 0.005;
    const auto edge = dimensions_of(step);
    expect_nominal(edge, "step height", 1e-6);
    expect_nominal(edge, "step height, areal", 1e-6);
    auto groove = over<Groove>(0.32, 0.001);
    groove.width = 0.06;
    groove.depth = 0.005;
    groove.wall = 0.004;
    const auto levels = dimensions_of(groove);
    expect_nominal(levels, "groove depth", 1e-6);
    expect_nominal(levels, "width at half depth", 1e-4);
    auto lines = over<Grating>(0.32, 0.001);
    lines.period = 0.03;
    lines.depth = 0.002;
    lines.line_width = 0.014;
    const auto pitch = dimensions_of(lines);
    expect_nominal(pitch, "pitch", 2e-3); // ten pixels a period: harmonics of the edges beat with them
    expect_nominal(pitch, "depth", 1e-4);
    auto prism = over<Prism>(0.32, 0.001);
    prism.height = -0.02;
    prism.flank = 60 * radians_per_degree;
    prism.top = 0.01;
    const auto flanks = dimensions_of(prism);
    expect_nominal(flanks, "flank angle, first", 1e-5);
    expect_nominal(flanks, "angle between the flanks", 1e-5);
    auto squares = over<CrossGrating>(0.32, 0.001);
    squares.period = 0.03;
    squares.period_y = 0.025;
    squares.angle = 80 * radians_per_degree;
    squares.line_width = 0.01;
    squares.depth = 0.001;
    const auto pitches = dimensions_of(squares);
    for (const char* name : {"pitch, first", "pitch, second", "angle between"})
        expect_nominal(pitches, name, 4e-3); // ten periods: the edges leak into the fundamental
    auto wave = over<Sinusoid>(0.32, 0.001);
    wave.amplitude = 0.001;
    wave.period = 0.061;
    const auto one_wave = dimensions_of(wave);
    expect_nominal(one_wave, "amplitude", 3e-3); // pixels take (pi pitch / period)^2 / 6
    expect_nominal(one_wave, "period", 1e-5);
    auto cross = over<CrossSinusoid>(0.32, 0.001);
    cross.amplitude = 0.0005;
    cross.period = 0.05;
    cross.period_y = 0.04;
    const auto two_waves = dimensions_of(cross);
    for (const char* name : {"amplitude, first", "amplitude, second", "period, first", "period, second"})
        expect_nominal(two_waves, name, 8e-3); // pixels and facets take (pi pitch / period)^2 / 6 each
    auto rings = over<RadialSinusoid>(0.32, 0.001);
    rings.amplitude = 0.001;
    rings.period = 0.05;
    const auto circles = dimensions_of(rings);
    expect_nominal(circles, "amplitude", 4e-3);
    expect_nominal(circles, "period", 1e-3);
    auto cap = over<Sphere>(0.32, 0.001);
    cap.representation = Representation::analytic;
    cap.radius = 0.25;
    cap.height = 0.01;
    const auto sphere = dimensions_of(cap);
    expect_nominal(sphere, "radius", 1e-4);
    EXPECT_LT(sphere.at("form deviation Sz").value, 5e-7);
    auto chirp = over<Chirp>(0.3, 0.001);
    chirp.amplitude = 0.001;
    chirp.period = 0.08;
    chirp.period_stop = 0.02;
    const auto transfers = dimensions_of(chirp);
    EXPECT_GE(transfers.size(), 7u);
    for (const auto& [name, one] : transfers)
        if (one.unit == dimensions::Dimension::Unit::ratio) {
            EXPECT_NEAR(one.value, 1, 0.03) << name;
        }
    auto bars = over<Plateaus>(0.3, 0.001);
    bars.text = "II";
    bars.font = "DejaVuSans-Bold";
    bars.text_width = 0.15;
    bars.heights = {0.002, 0.004};
    const auto plateaus = dimensions_of(bars);
    expect_nominal(plateaus, "plateau of 2 um", 1e-6);
    expect_nominal(plateaus, "plateau of 4 um", 1e-6);
}

TEST(StandardsAsSold, WhatDoesNotFitIsRefusedByItsKey) {
    const auto refused = [](const Shape& shape, const std::string& key) {
        try {
            (void)make({.shape = shape});
            ADD_FAILURE() << key;
        } catch (const InputError& error) {
            EXPECT_EQ(error.problem().key, "specimen." + key);
        }
    };
    auto lines = over<Grating>(0.1, 0.001);
    lines.period = 0.001;
    refused(lines, "period_um");
    lines.period = 0.02;
    lines.line_width = 0.02;
    refused(lines, "line_width_um");
    auto prism = over<Prism>(0.1, 0.001);
    prism.height = 0.1;
    prism.flank = 0.5;
    refused(prism, "height_um");
    auto squares = over<CrossGrating>(0.1, 0.001);
    squares.period = squares.period_y = 0.02;
    squares.line_width = 0.03;
    refused(squares, "line_width_um");
    auto texture = over<Deterministic>(0.1, 0.001);
    texture.period = 0.01;
    texture.orders = 8;
    refused(texture, "period_um");
}

} // namespace
