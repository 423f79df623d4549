#include "surface/form.hpp"

#include "core/mathematics/units.hpp"
#include "surface/filter.hpp"
#include "surface/height_parameters.hpp"
#include "surface/maps.hpp"
#include "surface/spatial_parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vkfv::surface {
namespace {

using namespace test;

Form named(const char* text) {
    const auto form = parse_form(text);
    EXPECT_TRUE(form) << text;
    return form.value_or(Form{});
}

double sq_after(const char* form, const HeightMap& map) {
    return height_parameters(remove_form(map, named(form))).sq;
}

TEST(Form, IsKnownByItsName) {
    for (const char* text : {"none", "plane", "polynomial-1", "polynomial-9", "polynomial-20", "sphere"})
        EXPECT_EQ(form_name(named(text)), text);
    EXPECT_EQ(named("polynomial-20").degree, 20);
    EXPECT_EQ(form_name({}), "plane");
    for (const char* text : {"", "Plane", "plane ", "polynomial", "polynomial-", "polynomial-0", "polynomial-21",
                             "polynomial-02", "polynomial--2", "polynomial-2x", "cone"})
        EXPECT_FALSE(parse_form(text)) << text;
}

TEST(Form, OfASphereLeavesTheWavesOnIt) {
    const double radius = 1, amplitude = 1e-5;
    // The wave has ten whole periods of ten points, even about the middle of the map.
    auto map = sampled(100, 100, 0.002, [=](double x, double y) {
        const double u = x + 0.3 - 0.099, v = y - 0.2 - 0.099;
        return -(u * u + v * v) / (radius + std::sqrt(radius * radius - u * u - v * v)) +
               amplitude * std::cos(2 * pi * u / 0.02);
    });
    // A parabola takes the share 90 / (pi k)^4 = 9.2e-5 of the mean square of k = 10 periods, a sphere less; the slopes
    // of up to 0.14 weigh the points by up to 2 % less, which changes that share as much.
    const double waves = amplitude / std::sqrt(2);
    EXPECT_NEAR(sq_after("sphere", map), waves, 1e-4 * waves);
    // The wrong twins: a parabola leaves r^4 / (8 R^3), up to 5 amplitudes, of which a quarter is not parabolic; a
    // plane leaves nearly all.
    EXPECT_GT(sq_after("polynomial-2", map), 1.02 * waves);
    EXPECT_GT(sq_after("plane", map), 100 * waves);
}

TEST(Form, OfAPolynomialLeavesNothingOfOneOfItsDegree) {
    auto map = sampled(50, 40, 0.002, [](double x, double y) { return 0.1 + x - 2 * x * y + 3 * y * y; });
    forget_a_third(map);
    EXPECT_LT(sq_after("polynomial-2", map), 1e-14); // heights of 0.5 mm
    EXPECT_GT(sq_after("polynomial-1", map), 1e-4);
    map.height(7, 7) += 1;
    EXPECT_GT(sq_after("polynomial-2", map), 1e-3);
}

TEST(Form, OfAPlaneIsTheLeastSquaresPlaneAndNoneIsNone) {
    auto map = sampled(20, 30, 0.002, [](double x, double y) { return std::sin(300 * x) + y * y; });
    forget_a_third(map);
    const HeightMap level = remove_plane(map, least_squares_plane(map)), plane = remove_form(map, {}),
                    none = remove_form(map, named("none"));
    for (std::size_t k = 0; k < map.height.values.size(); ++k)
        if (std::isfinite(map.height.values[k])) {
            EXPECT_EQ(plane.height.values[k], level.height.values[k]);
            EXPECT_EQ(none.height.values[k], map.height.values[k]);
        }
}

TEST(Form, LeavesNoRounding) {
    for (const bool gaps : {false, true})
        for (const double slope : {0.0, 0.5}) {
            auto map = sampled(300, 200, 0.002, [=](double x, double y) { return 0.1 + slope * x - 0.4 * slope * y; });
            if (gaps)
                forget_a_third(map);
            for (const char* form : {"plane", "polynomial-1", "polynomial-3"}) {
                const HeightMap rest = remove_form(map, named(form));
                const HeightParameters p = height_parameters(rest);
                EXPECT_EQ(p.sz, 0) << form;
                EXPECT_TRUE(std::isnan(p.ssk) && std::isnan(p.sku)) << form;
                EXPECT_TRUE(std::isnan(spatial_parameters(rest).sal)) << form;
                EXPECT_TRUE(std::isnan(spatial_parameters(rest).std_angle)) << form;
                EXPECT_EQ(p.measured_share, height_parameters(map).measured_share);
                // A thousandth of a nanometre is no rounding.
                HeightMap marked = map;
                for (std::size_t k = 0; k < marked.height.values.size(); k += 2)
                    marked.height.values[k] += 1e-9;
                EXPECT_NEAR(height_parameters(remove_form(marked, named(form))).sq, 5e-10, 1e-11) << form;
            }
        }
}

TEST(Form, OfASphereThatNothingSettlesLeavesNoPoint) {
    const auto flat = sampled(9, 9, 0.1, [](double x, double y) { return x + y; });
    EXPECT_EQ(height_parameters(remove_form(flat, named("sphere"))).measured_share, 0);
}

} // namespace
} // namespace vkfv::surface
