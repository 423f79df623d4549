#include "dimensions/waves.hpp"

#include "dimensions/evaluate.hpp"
#include "dimensions/made_maps.hpp"
#include "dimensions/sphere_form.hpp"
#include "dimensions/transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vkfv::dimensions {
namespace {

using namespace test;
using surface::HeightMap;

constexpr double pi = 180 * degrees;

TEST(Waves, ASinusoidHasItsAmplitudeAndPeriodFromAStartThatIsOff) {
    for (const double angle : {0.0, 33.0, 90.0}) {
        const Frame frame{.x = 0.01, .angle = angle * degrees};
        const HeightMap map = made(frame, [](double u, double) { return 0.001 * std::sin(2 * pi * u / 0.0612 + 1); },
                                   {.tilt_x = 0.02, .tilt_y = -0.01, .gaps = 0.3});
        // The nominal period is 0.06: over the map a tenth of a cycle too many.
        const auto found = fitted_waves(map, frame, {{std::cos(frame.angle) / 0.06, std::sin(frame.angle) / 0.06}});
        ASSERT_TRUE(found) << angle;
        EXPECT_NEAR(found->waves[0].amplitude, 0.001, 1e-11) << angle;
        EXPECT_NEAR(found->waves[0].period(), 0.0612, 1e-9) << angle;
        EXPECT_LT(found->residue, 1e-12);
    }
}

TEST(Waves, StandardErrorsAreTheScatters) {
    double amplitudes = 0, told_amplitudes = 0, periods = 0, told_periods = 0;
    for (unsigned seed = 1; seed <= 25; ++seed) {
        const HeightMap map = made({}, [](double u, double) { return 0.001 * std::sin(2 * pi * u / 0.06); },
                                   {.noise = 5e-4, .gaps = 0.8, .seed = seed});
        const auto wave = fitted_waves(map, {}, {{1 / 0.06, 0.0}})->waves[0];
        amplitudes += std::pow(wave.amplitude - 0.001, 2);
        told_amplitudes += std::pow(wave.amplitude_error, 2);
        periods += std::pow(wave.period() - 0.06, 2);
        told_periods += std::pow(wave.period_error, 2);
    }
    // Chi-square of 25 degrees of freedom, over these, lies between both bounds with 99.8 %.
    for (const double ratio : {amplitudes / told_amplitudes, periods / told_periods}) {
        EXPECT_GT(ratio, 1 / 2.7);
        EXPECT_LT(ratio, 2.3);
    }
}

TEST(Waves, TwoAcrossEachOtherAndTheStrongestIsFound) {
    const Frame frame{.angle = 10 * degrees};
    const HeightMap map = made(frame, [](double u, double v) {
        return 0.002 * std::sin(2 * pi * u / 0.05) + 0.001 * std::cos(2 * pi * v / 0.03);
    });
    const auto first = strongest_frequency(map);
    ASSERT_TRUE(first);
    EXPECT_NEAR(1 / std::hypot((*first)[0], (*first)[1]), 0.05, 0.003);
    const auto second = strongest_frequency(map, first);
    ASSERT_TRUE(second);
    const auto found = fitted_waves(map, {}, {*first, *second});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->waves[0].amplitude, 0.002, 1e-11);
    EXPECT_NEAR(found->waves[1].amplitude, 0.001, 1e-11);
    EXPECT_NEAR(found->waves[1].period(), 0.03, 1e-9);
}

TEST(Waves, ARadialWave) {
    const Frame frame{.x = -0.02, .y = 0.01};
    const HeightMap map =
        made(frame, [](double u, double v) { return 0.001 * std::cos(2 * pi * std::hypot(u, v) / 0.041); },
             {.tilt_x = 0.01});
    const auto found = fitted_radial_wave(map, frame, 1 / 0.04);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->waves[0].amplitude, 0.001, 1e-11);
    EXPECT_NEAR(found->waves[0].period(), 0.041, 1e-9);
}

TEST(Waves, NoneInALevelMapOrOneTooShort) {
    EXPECT_FALSE(fitted_waves(made({}, [](double, double) { return 0.0; }, {.gaps = 1}), {}, {{20.0, 0.0}}));
    EXPECT_FALSE(fitted_waves(made({}, [](double u, double) { return std::sin(2 * u); }), {}, {{1 / pi, 0.0}}));
    // A map does not grow longer where the frame's origin stands at its edge: one and a third periods are too few.
    const HeightMap map = made({}, [](double, double) { return 0.0; });
    const double length = std::hypot(map.x(map.columns() - 1) - map.x(0), map.y(map.rows() - 1) - map.y(0));
    for (const double x : {0.0, map.x(0)}) {
        const Frame frame{.x = x};
        const double frequency = 4.0 / 3 / length;
        const HeightMap wave = made(frame, [&](double u, double) { return 0.001 * std::sin(2 * pi * frequency * u); });
        EXPECT_FALSE(fitted_waves(wave, frame, {{frequency, 0.0}})) << x;
    }
}

TEST(Transfer, OfAChirpSmoothedByABoxIsItsSinc) {
    const Chirp chirp{
        .frame = {}, .amplitude = 0.001, .start = -0.2, .length = 0.4, .period_start = 0.08, .period_stop = 0.016};
    const double box = 0.012;
    const auto phase = [&](double u) {
        const double s = u - chirp.start, f = 1 / chirp.period_start;
        return 2 * pi * (f + 0.5 * (1 / chirp.period_stop - f) / chirp.length * s) * s;
    };
    const auto smoothed = [&](double u, double) {
        double sum = 0;
        for (int k = 0; k < 60; ++k)
            sum += chirp.amplitude * std::sin(phase(u + box * ((k + 0.5) / 60 - 0.5))) / 60;
        return sum;
    };
    const auto transfers = chirp_transfer(made({}, smoothed, {.tilt_x = 0.002, .noise = 2e-5, .gaps = 0.1}), chirp);
    ASSERT_GT(transfers.size(), 8u);
    for (const auto& one : transfers) {
        const double x = pi * box / one.period;
        // The tolerance is for a wave's frequency, which changes over its length.
        EXPECT_NEAR(one.ratio, std::sin(x) / x, 0.03 + 4 * one.standard_error) << one.period;
    }
    EXPECT_NEAR(*period_at_half(transfers), box / 0.6034, 0.0008); // sinc(0.6034) = 1/2
}

TEST(Transfer, OfASharpStarIsOneAndOfAHalvedOneAHalf) {
    Star star{.frame = {.x = 0.01, .y = 0.005}, .petals = 12, .radius = 0.11, .height = 0.004};
    const HeightMap map =
        made(star.frame,
             [&](double u, double v) {
                 const double petal = std::atan2(v, u) / (2 * pi) * star.petals;
                 return std::hypot(u, v) < star.radius && petal - std::floor(petal) < 0.5 ? star.height : 0.0;
             },
             {.tilt_x = 0.01, .gaps = 0.2});
    for (const auto& one : star_transfer(map, star)) {
        if (one.period > 0.012) {
            EXPECT_NEAR(one.ratio, 1, 0.03 + 4 * one.standard_error) << one.period;
        }
    }
    star.height *= 2;
    EXPECT_NEAR(star_transfer(map, star).front().ratio, 0.5, 0.01);
}

// Pixels and focus windows round the rim, but no ring that is evaluated reaches so far.
TEST(Transfer, OfAStarDoesNotDependOnItsRim) {
    const Star star{.frame = {}, .petals = 12, .radius = 0.11, .height = 0.004};
    const HeightMap map = made(star.frame, [&](double u, double v) {
        const double petal = std::atan2(v, u) / (2 * pi) * star.petals;
        const double rounded = std::clamp((star.radius - std::hypot(u, v)) / 0.01, 0.0, 1.0);
        return petal - std::floor(petal) < 0.5 ? star.height * rounded : 0.0;
    });
    EXPECT_NEAR(star_transfer(map, star).front().ratio, 1, 0.02);
}

// A long wave that noise lowers does not hide the limit.
TEST(Transfer, FallsToAHalfBelowItsLargestValue) {
    const auto half = period_at_half(
        {{.period = 0.02, .ratio = 0.4}, {.period = 0.015, .ratio = 0.9}, {.period = 0.01, .ratio = 0.3}});
    ASSERT_TRUE(half);
    EXPECT_NEAR(*half, 0.015 - 0.005 * 0.4 / 0.6, 1e-12);
    EXPECT_FALSE(period_at_half({{.period = 0.02, .ratio = 0.4}, {.period = 0.01, .ratio = 0.3}}));
}

TEST(SphereForm, ACapOnAPlaneWithoutItsFlanks) {
    const SphereCap cap{.frame = {.x = 0.01, .y = -0.01}, .radius = 0.15, .height = 0.05};
    double sum = 0, told = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        HeightMap map = made(cap.frame,
                             [&](double u, double v) {
                                 const double square = u * u + v * v;
                                 return std::max(0.0, cap.height - cap.radius +
                                                          std::sqrt(std::max(0.0, cap.radius * cap.radius - square)));
                             },
                             {.noise = 1e-5, .gaps = 0.7, .seed = seed});
        const auto form = sphere_form(map, cap);
        ASSERT_TRUE(form);
        // Noise along z is shorter along the cap's normal.
        EXPECT_NEAR(form->rms, 0.9e-5, 0.15e-5);
        sum += std::pow(form->sphere.radius - cap.radius, 2);
        told += std::pow(form->radius_error, 2);
    }
    EXPECT_GT(sum / told, 0.25);
    EXPECT_LT(sum / told, 2.75); // chi-square of 12: 99.9 %
    EXPECT_FALSE(sphere_form(made({}, [](double, double) { return 0.0; }, {.gaps = 0.9}), cap));
}

TEST(FlankAngles, OfATiltedPrism) {
    const Prism prism{.frame = {.angle = 90 * degrees}, .height = 0.04, .flank_angle = 45 * degrees, .top_width = 0.02};
    const double slope = std::tan(prism.flank_angle);
    const HeightMap map =
        made(prism.frame,
             [&](double u, double) {
                 return std::clamp(prism.height - slope * (std::abs(u) - prism.top_width / 2), 0.0, prism.height);
             },
             {.gaps = 0.2});
    const auto angles = flank_angles(map, prism);
    ASSERT_TRUE(angles);
    EXPECT_NEAR(angles->before.mean, 45 * degrees, 1e-9);
    EXPECT_NEAR(angles->behind.mean, 45 * degrees, 1e-9);
}

TEST(Evaluate, ACrossGratingHasItsPitchesAndItsAngle) {
    const CrossGrating grating{
        .frame = {.angle = 3 * degrees}, .pitch_u = 0.03, .pitch_v = 0.04, .angle = 88 * degrees};
    const double turned = grating.frame.angle + grating.angle;
    const HeightMap map = made(
        {},
        [&](double x, double y) {
            const auto square = [](double turns) { return turns - std::floor(turns) < 0.5; };
            return square((x * std::cos(grating.frame.angle) + y * std::sin(grating.frame.angle)) / grating.pitch_u) &&
                           square((x * std::cos(turned) + y * std::sin(turned)) / grating.pitch_v)
                       ? 0.002
                       : 0.0;
        },
        {.tilt_y = 0.01});
    const auto found = evaluate(map, grating);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_NEAR(found[0].value, grating.pitch_u, 1e-4); // seven periods and a half: what is no sinusoid leaks into them
    EXPECT_NEAR(found[1].value, grating.pitch_v, 1e-4);
    EXPECT_NEAR(found[2].value, grating.angle, 0.1 * degrees);
}

TEST(Evaluate, WhatIsNotThereHasNoValueAndKeepsItsPlace) {
    const HeightMap flat{.height = Grid<double>(40, 30), .x0 = -0.2, .y0 = -0.15, .pitch_x = 0.01, .pitch_y = 0.01};
    HeightMap none = flat;
    none.height = Grid<double>(40, 30, surface::undefined);
    for (const Feature& feature : std::initializer_list<Feature>{
             Step{.frame = {}, .height = 0.001}, Groove{.frame = {}, .width = 0.05, .depth = 0.01},
             Prism{.frame = {}, .height = 0.01, .flank_angle = 0.5},
             Grating{.frame = {}, .period = 0.03, .depth = 0.01, .line_width = 0.015},
             CrossGrating{.frame = {}, .pitch_u = 0.03, .pitch_v = 0.03, .angle = 1.5},
             Sinusoid{.frame = {}, .amplitude = 0.001, .period = 0.05},
             CrossSinusoid{.frame = {}, .amplitude = 0.001, .period_u = 0.05, .period_v = 0.05},
             RadialSinusoid{.frame = {}, .amplitude = 0.001, .period = 0.05},
             Chirp{.frame = {},
             .amplitude = 0.001,
             .start = -0.1,
             .length = 0.2,
             .period_start = 0.03,
             .period_stop = 0.02},
             Star{.frame = {}, .petals = 12, .radius = 0.1, .height = 0.001},
             SphereCap{.frame = {}, .radius = 0.1, .height = 0.02}, Flat{}}) {
        const auto found = evaluate(none, feature), others = evaluate(flat, feature);
        ASSERT_EQ(found.size(), others.size()) << feature.index();
        for (std::size_t k = 0; k < found.size(); ++k) {
            EXPECT_TRUE(std::isnan(found[k].value)) << found[k].name;
            EXPECT_EQ(found[k].name, others[k].name);
        }
    }
}

} // namespace
} // namespace vkfv::dimensions
