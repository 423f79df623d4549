#include "surface/roughness_profile.hpp"

#include "core/mathematics/units.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::surface {
namespace {

using namespace test;
using Kind = ProfileSetting::Kind;

// A wave along x, at points 2 um apart; 800 of them are 1.6 mm.
HeightMap wave(double amplitude, double wavelength, int points) {
    return sampled(points, 1, 0.002, [=](double x, double) { return amplitude * std::sin(2 * pi * x / wavelength); });
}

RoughnessProfile measured(const HeightMap& map, const ProfileSetting& setting) {
    return roughness_profile(map, middle_row(map), setting);
}

TEST(RoughnessProfile, TakesTheFilterThatIsAsked) {
    // The map is 4 mm long, with waves of 50 um: a filter of 0.8 mm takes nothing of their amplitude, and without a
    // filter all stays.
    const double amplitude = 1e-3;
    const HeightMap map = wave(amplitude, 0.05, 2001);
    const double ra = 2 / pi * amplitude;
    const RoughnessProfile fifth = measured(map, {});
    EXPECT_NEAR(fifth.l_filter, 0.8, 1e-9);
    EXPECT_NEAR(fifth.section_length, 0.8, 1e-9);
    EXPECT_EQ(fifth.setting_class, nullptr);
    const RoughnessProfile none = measured(map, {.kind = Kind::nesting_index, .nesting_index = 0});
    EXPECT_EQ(none.l_filter, 0);
    EXPECT_NEAR(none.parameters.ra, ra, 0.005 * ra);
    // By ISO 16610-21 half of a wave of the cut-off wavelength is short; ends of 5 % of the profile are filtered by
    // half a window.
    const RoughnessProfile half = measured(map, {.kind = Kind::nesting_index, .nesting_index = 0.05});
    EXPECT_NEAR(half.parameters.ra, ra / 2, 0.03 * ra);
    EXPECT_NEAR(fifth.parameters.ra, ra, 0.01 * ra);
}

TEST(RoughnessProfile, OfAClassIsThatOfFiveOfItsSections) {
    // Waves of 50 um are in the middle 1.25 mm of 3 mm, and ten times as high outside the evaluation length of Sc2.
    const HeightMap map = sampled(1501, 1, 0.002, [](double x, double) {
        const double apart = std::abs(x + 0.3 - 1.5);
        return (apart > 1.2 ? 1e-3 : 1e-4) * std::sin(2 * pi * x / 0.05);
    });
    const RoughnessProfile result = measured(map, {.kind = Kind::by_class, .setting_class = 1});
    ASSERT_NE(result.setting_class, nullptr);
    EXPECT_EQ(result.setting_class->name, "Sc2");
    EXPECT_EQ(result.l_filter, 0.25);
    EXPECT_EQ(result.section_length, 0.25);
    EXPECT_NEAR(result.parameters.ra, 2 / pi * 1e-4, 0.02e-4);
    EXPECT_NEAR(result.parameters.rz, 2e-4, 0.04e-4);
    // A profile of 3 mm is too short for 4 mm.
    EXPECT_TRUE(std::isnan(measured(map, {.kind = Kind::by_class, .setting_class = 2}).parameters.ra));
}

TEST(RoughnessProfile, FindsTheClassByRa) {
    // Ra is 2 / pi of the amplitude; classes end at 0.02, 0.1 and 2 um.
    const double wavelength = 0.03;
    const auto name_of = [&](double ra, int points) {
        const RoughnessProfile result = measured(wave(ra * pi / 2, wavelength, points), {.kind = Kind::by_ra});
        EXPECT_FALSE(std::isnan(result.parameters.ra));
        return result.setting_class->name;
    };
    EXPECT_EQ(name_of(0.015e-3, 2101), "Sc1");
    EXPECT_EQ(name_of(0.05e-3, 2101), "Sc2");
    EXPECT_EQ(name_of(1e-3, 2101), "Sc3");
    EXPECT_EQ(name_of(3e-3, 6301), "Sc4");
    // A profile of 4.2 mm is too short for Ra of 3 um, which asks for 12.5 mm.
    const RoughnessProfile shorter = measured(wave(3e-3 * pi / 2, wavelength, 2101), {.kind = Kind::by_ra});
    EXPECT_EQ(shorter.setting_class->name, "Sc4");
    EXPECT_TRUE(std::isnan(shorter.parameters.ra));
}

} // namespace
} // namespace vkfv::surface
