#include "surface/profile_elements.hpp"

#include "core/mathematics/units.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::surface {
namespace {

constexpr double amplitude = 0.002, spacing = 1e-3;
constexpr int points_a_period = 200, periods = 10;
constexpr int whole_elements = periods - 2; // a sine crosses upwards after 1, 2, ... 9 periods

template <class Height>
Profile made(const Height& height) {
    Profile profile{.height = {}, .spacing = spacing};
    for (int k = 0; k < points_a_period * periods; ++k)
        profile.height.push_back(height((k + 0.5) / points_a_period));
    return profile;
}

double sine(double turns) {
    return amplitude * std::sin(2 * pi * turns);
}

// All parameters of a sinusoid over whole periods follow from integrals; points are half a step off its crossings.
TEST(ProfileElements, ParametersOfASinusoidHaveTheirClosedForms) {
    const auto p = profile_parameters(made(sine), 5);
    const double step = pi / points_a_period; // half a point, in rad: what sampling may miss, squared
    const double missed = amplitude * step * step;
    EXPECT_NEAR(p.ra, 2 / pi * amplitude, missed);
    EXPECT_NEAR(p.rq, amplitude / std::sqrt(2.0), missed);
    for (const double height : {p.rp, p.rv, p.rt / 2, p.rz / 2, p.rc / 2})
        EXPECT_NEAR(height, amplitude, missed);
    EXPECT_NEAR(p.rsk, 0, 1e-9);
    EXPECT_NEAR(p.rku, 1.5, 1e-9);
    EXPECT_NEAR(p.rsm, points_a_period * spacing, 1e-9);
    // Differences of neighbours are 2 A sin(pi / n) over the spacing, a cosine again. Of 2000 differences one of the
    // steepest is missing: a 2000th of the mean square.
    EXPECT_NEAR(p.rdq, std::sqrt(2.0) * amplitude * std::sin(pi / points_a_period) / spacing, p.rdq / 2000);
    // The height exceeded on a share m is A cos(pi m).
    EXPECT_NEAR(p.rdc, 2 * amplitude * std::cos(0.02 * pi), 0.01 * amplitude);
}

// Heights of a ramp are uniform: the material ratio curve is a straight line, all core.
TEST(ProfileElements, ARampIsAllCore) {
    const auto p = profile_parameters(made([](double turns) { return 0.01 * turns; }), 5);
    const double height = 0.01 * periods;
    EXPECT_NEAR(p.rk, height, 1e-9);
    EXPECT_NEAR(p.rpk, 0, 1e-3 * height);
    EXPECT_NEAR(p.rvk, 0, 1e-3 * height);
    EXPECT_NEAR(p.rmrk1, 0, 1e-3);
    EXPECT_NEAR(p.rmrk2, 1, 1e-3);
    EXPECT_NEAR(p.rdc, 0.96 * height, 1e-3 * height);
}

// A ripple of less than a tenth of Rz crosses the reference line more often, and is no element.
TEST(ProfileElements, RippleIsNoElement) {
    const auto rippled = [](double ripple) {
        return made([=](double turns) { return sine(turns) + ripple * std::sin(2 * pi * turns * 23); });
    };
    const auto small = profile_elements(rippled(0.1 * amplitude), 0, 0.2 * amplitude);
    EXPECT_EQ(small.count, whole_elements);
    EXPECT_NEAR(small.mean_spacing, points_a_period * spacing, 0.02 * points_a_period * spacing);
    const auto large = profile_elements(rippled(0.9 * amplitude), 0, 0.2 * amplitude);
    EXPECT_GT(large.count, 2 * periods);
}

TEST(ProfileElements, GapsEndElements) {
    Profile profile = made(sine);
    profile.height[points_a_period * 5 / 2] = undefined;
    const auto found = profile_elements(profile, 0, 0.2 * amplitude);
    EXPECT_EQ(found.count, whole_elements - 1);
    EXPECT_NEAR(found.mean_spacing, points_a_period * spacing, 1e-9);
    EXPECT_TRUE(std::isnan(profile_elements({{}, spacing}, 0, 0).mean_spacing));
}

} // namespace
} // namespace vkfv::surface
