#include "surface/profile.hpp"

#include "core/mathematics/units.hpp"
#include "surface/maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace vkfv::surface {
namespace {

using namespace test;

TEST(Profile, IsExactForWhatIsBilinear) {
    auto map = sampled(41, 31, 0.01, [](double x, double y) { return 1 + 2 * x - 3 * y + 5 * x * y; });
    // The profile runs between points and obliquely; cells are whole from the map's edges.
    const Profile p = extract_profile(map, -0.3, 0.2, 0.1, 0.5, 0.003);
    // The length is 0.5 / 0.003 = 166.7 steps. x y is bilinear in a cell, but a line leaves it: at the points
    // themselves it holds.
    ASSERT_EQ(p.height.size(), 167u);
    for (std::size_t k = 0; k < p.height.size(); ++k) {
        const double x = -0.3 + 0.8 * 0.003 * static_cast<double>(k), y = 0.2 + 0.6 * 0.003 * static_cast<double>(k);
        EXPECT_NEAR(p.height[k], 1 + 2 * x - 3 * y + 5 * x * y, 1e-13);
    }
}

TEST(Profile, HasGapsWhereAPointThatCountsIsNotMeasured) {
    auto map = sampled(11, 3, 0.01, [](double x, double) { return x; });
    map.height(5, 1) = not_measured;
    map.height(5, 2) = not_measured;
    // Along the row of grid points 1, in steps of half a point, 4.5, 5 and 5.5 need column 5.
    const Profile on = extract_profile(map, -0.3, 0.21, -0.2, 0.21, 0.005);
    ASSERT_EQ(on.height.size(), 21u);
    for (int k = 0; k < 21; ++k)
        EXPECT_EQ(std::isnan(on.height[static_cast<std::size_t>(k)]), k >= 9 && k <= 11) << k;
    // Row 0 alone is whole: its neighbours have no weight.
    for (const double z : extract_profile(map, -0.3, 0.2, -0.2, 0.2, 0.005).height)
        EXPECT_FALSE(std::isnan(z));
    // There are no heights beyond the map.
    EXPECT_TRUE(std::isnan(extract_profile(map, -0.31, 0.2, -0.2, 0.2, 0.01).height.front()));
    EXPECT_THROW(extract_profile(map, 0, 0, 1, 1, 0), std::invalid_argument);
}

TEST(Profile, FilterPassesHalfAtItsCutOff) {
    const double wavelength = 0.08, spacing = 0.001;
    Profile wave{.height = {}, .spacing = spacing};
    for (int k = -400; k <= 400; ++k)
        wave.height.push_back(std::cos(2 * pi * k * spacing / wavelength));
    // The tolerance is that of the areal filter (filter_test.cpp): the weights beyond the cut-off are missing, 1e-5.
    EXPECT_NEAR(gaussian_low_pass(wave, wavelength).height[400], 0.5, 1e-5);
    EXPECT_NEAR(remove_long_waves(wave, wavelength).height[400], 0.5, 1e-5);
    EXPECT_NEAR(gaussian_low_pass(wave, wavelength / 2).height[400], std::pow(0.5, 0.25), 1e-5);
}

TEST(Profile, ParametersOfASampledSinusoid) {
    const double amplitude = 0.002, n = 20;
    Profile wave{.height = {}, .spacing = 0.001};
    for (int k = 0; k < 400; ++k)
        wave.height.push_back(0.7 + amplitude * std::sin(2 * pi * k / n));
    const ProfileParameters p = profile_parameters(wave);
    EXPECT_NEAR(p.ra, amplitude * 2 / n / std::tan(pi / n), 1e-14); // closed form for points at k / n of the period
    EXPECT_NEAR(p.rq, amplitude / std::sqrt(2.0), 1e-14);
    EXPECT_NEAR(p.rz, 2 * amplitude, 1e-14);
}

TEST(Profile, RzIsTheMeanOfItsSectionsAndNotTheWhole) {
    Profile p{.height = {}, .spacing = 0.001};
    for (int section = 1; section <= 5; ++section)
        for (int k = 0; k < 10; ++k)
            p.height.push_back(k == 3 ? section : k == 7 ? -section : 0);
    EXPECT_DOUBLE_EQ(profile_parameters(p).rz, 6); // (2 + 4 + 6 + 8 + 10) / 5
    EXPECT_DOUBLE_EQ(profile_parameters(p, 1).rz, 10);
    p.height[3] = not_measured;
    EXPECT_DOUBLE_EQ(profile_parameters(p).rz, 5.8);
    std::fill(p.height.begin(), p.height.begin() + 10, not_measured);
    EXPECT_TRUE(std::isnan(profile_parameters(p).rz));
    EXPECT_THROW(profile_parameters(p, 0), std::invalid_argument);
}

} // namespace
} // namespace vkfv::surface
