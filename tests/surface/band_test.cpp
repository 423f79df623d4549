#include "surface/band.hpp"

#include "core/mathematics/units.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/maps.hpp"
#include "surface/robust_filter.hpp"
#include "surface/spline_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string_view>

namespace vkfv::surface {
namespace {

using namespace test;

void expect_same(const HeightMap& a, const HeightMap& b) {
    for (std::size_t k = 0; k < a.height.values.size(); ++k) {
        EXPECT_EQ(std::isnan(a.height.values[k]), std::isnan(b.height.values[k]));
        if (!std::isnan(a.height.values[k])) {
            EXPECT_EQ(a.height.values[k], b.height.values[k]);
        }
    }
}

HeightMap waves() {
    return sampled(60, 50, 0.001, [](double x, double y) {
        return 0.3 + 0.1 * x + 1e-3 * std::sin(2 * pi * x / 0.005) + 1e-3 * std::sin(2 * pi * y / 0.03);
    });
}

TEST(Band, IsFormThenShortThenLongWaves) {
    auto map = waves();
    forget_a_third(map);
    const HeightMap level = remove_plane(map, least_squares_plane(map));
    expect_same(scale_limited(map, {}), level);
    const HeightMap smooth = gaussian_low_pass(level, 0.005);
    expect_same(scale_limited(map, {.s_filter = 0.005}), smooth);
    expect_same(scale_limited(map, {.s_filter = 0.005, .l_filter = 0.03}), remove_long_waves(smooth, 0.03));
    expect_same(scale_limited(map, {.s_filter = 0.005, .form = {.kind = Form::Kind::none}}),
                gaussian_low_pass(map, 0.005));
    expect_same(filtered(map, {.s_filter = 0.005}), gaussian_low_pass(map, 0.005));
}

TEST(Band, TakesTheSplineIfAsked) {
    const auto map = waves();
    const HeightMap level = remove_plane(map, least_squares_plane(map));
    const HeightMap spline = scale_limited(map, {.s_filter = 0.005, .spline = true});
    expect_same(spline, spline_low_pass(level, 0.005));
    EXPECT_NE(spline.height(30, 20), gaussian_low_pass(level, 0.005).height(30, 20));
}

TEST(Band, TakesAndSaysTheNameOfItsFilter) {
    const auto map = waves();
    for (const char* name : filter_names) {
        Band band{.s_filter = 0.005, .form = {.kind = Form::Kind::none}};
        take_filter(band, name);
        EXPECT_STREQ(filter_name(band), name);
        const std::string_view word = name;
        expect_same(scale_limited(map, band), word == "gaussian" ? gaussian_low_pass(map, 0.005)
                                              : word == "spline" ? spline_low_pass(map, 0.005, SplineEnds::natural)
                                              : word == "spline-mirrored"
                                                  ? spline_low_pass(map, 0.005, SplineEnds::mirrored)
                                                  : robust_gaussian_low_pass(map, 0.005));
    }
    Band band;
    EXPECT_THROW(take_filter(band, "box"), std::invalid_argument);
}

TEST(Band, LeavesNoRoundingOfAConstant) {
    auto map = sampled(60, 50, 0.001, [](double, double) { return 0.1; });
    forget_a_third(map);
    for (const bool spline : {false, true}) {
        const HeightMap rest =
            scale_limited(map, {.l_filter = 0.03, .spline = spline, .form = {.kind = Form::Kind::none}});
        EXPECT_EQ(height_parameters(rest).sz, 0);
        EXPECT_TRUE(std::isnan(height_parameters(rest).sku));
    }
}

TEST(Band, IsLimitedByFiltersAlone) {
    EXPECT_FALSE(Band{}.limited());
    EXPECT_FALSE(Band{.form = {.kind = Form::Kind::sphere}}.limited());
    EXPECT_TRUE(Band{.s_filter = 1}.limited());
    EXPECT_TRUE(Band{.l_filter = 1}.limited());
}

} // namespace
} // namespace vkfv::surface
