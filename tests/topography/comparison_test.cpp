#include "topography/comparison.hpp"

#include "surface/areal_parameters.hpp"
#include "topography/waves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace vkfv::topography {
namespace {

using surface::Form;
using surface::HeightMap;

constexpr double um = 1e-3; // mm

HeightMap truth_map() {
    return test::map_of(test::random_waves(30, 20, 120, 0.2 * um, 1), 64, 60, 1 * um, 0, 0, [](double) { return 1.0; });
}

// The truth with further waves of 2 um and an offset of 3 um on it.
HeightMap measured_map(unsigned seed) {
    HeightMap map = truth_map();
    const auto noise = test::map_of(test::random_waves(30, 400, 500, 0.05 * um, seed), 64, 60, 1 * um, 0, 0,
                                    [](double) { return 1.0; });
    for (std::size_t k = 0; k < map.height.values.size(); ++k)
        map.height.values[k] += noise.height.values[k] + 3 * um;
    map.height(5, 7) = std::nan("");
    return map;
}

TEST(Comparison, IsOfTheTreatedSurfacesButTransferAndSlopesOfTheLevelledOnes) {
    const std::vector<HeightMap> measurements = {measured_map(2), measured_map(3)};
    const Band band{.s_filter = 6 * um, .l_filter = 40 * um, .form = {.kind = Form::Kind::polynomial, .degree = 2}};
    const Comparison plain = compare_with_truth(measurements, truth_map(), false);
    const Comparison treated = compare_with_truth(measurements, truth_map(), false, band);

    HeightMap truth = truth_map();
    truth.height(5, 7) = std::nan("");
    const HeightMap a = scale_limited(measurements[0], band), b = scale_limited(truth, band);
    EXPECT_EQ(treated.measurements[0].measured.height.sq, surface::height_parameters(a).sq);
    EXPECT_EQ(treated.measurements[0].truth.hybrid.sdq, surface::hybrid_parameters(b).sdq);
    EXPECT_EQ(treated.measurements[0].deviation.sq_true, surface::height_parameters(b).sq);
    EXPECT_EQ(treated.measurements[0].deviation.rms, compare(measurements[0], truth, band).rms);

    // The wave of 2 um passes an S-filter of 6 um with 2^-9, but for the borders, where half of the window is missing.
    EXPECT_LT(treated.measurements[0].deviation.rms, 0.2 * plain.measurements[0].deviation.rms);
    EXPECT_LT(treated.parts->random, 0.2 * plain.parts->random);
    EXPECT_GT(treated.measurements[0].deviation.correlation, plain.measurements[0].deviation.correlation);

    ASSERT_EQ(treated.transfer.size(), plain.transfer.size());
    for (std::size_t k = 0; k < plain.transfer.size(); ++k)
        EXPECT_EQ(treated.transfer[k].transfer, plain.transfer[k].transfer);
    ASSERT_EQ(treated.slopes.size(), plain.slopes.size());
    for (std::size_t k = 0; k < plain.slopes.size(); ++k)
        EXPECT_EQ(treated.slopes[k].rms, plain.slopes[k].rms);
    EXPECT_EQ(treated.measurements[0].shift.x, plain.measurements[0].shift.x);
}

TEST(Comparison, WithoutFormKeepsTheOffset) {
    const HeightMap measured = measured_map(2), truth = truth_map();
    // The root mean square of 30 waves of 0.05 um beside 3 um is sqrt(9 + 30 * 0.05^2 / 2), the waves' mean square
    // known to a tenth or so.
    EXPECT_NEAR(compare(measured, truth, {.form = {.kind = Form::Kind::none}}).rms, 3.006 * um, 0.003 * um);
    EXPECT_LT(compare(measured, truth).rms, 0.3 * um);
    EXPECT_NEAR(deviation_map(measured, truth, {.form = {.kind = Form::Kind::none}}).height(30, 30), 3 * um, um);
}

// A plane through a step of height h takes three quarters of its mean square, h^2 / 4: slope 3 h / (2 L) over the
// length L.
TEST(Comparison, InTheTruthsPlaneKeepsAStep) {
    const auto of_slope = [](double slope) {
        HeightMap map{.height = Grid<double>(200, 20), .x0 = -99.5 * um, .y0 = 0, .pitch_x = um, .pitch_y = um};
        for (int row = 0; row < map.rows(); ++row)
            for (int column = 0; column < map.columns(); ++column)
                map.height(column, row) =
                    (map.x(column) > 0 ? 4 * um : 0) + slope * map.x(column) + 2 * slope * map.y(row);
        return map;
    };
    const Band as_true{.form = {.kind = Form::Kind::truth}};
    const Deviation kept = compare(of_slope(0.03), of_slope(0), as_true);
    EXPECT_NEAR(kept.sq_measured, 2 * um, 1e-9 * um);
    EXPECT_NEAR(kept.sq_true, 2 * um, 1e-9 * um);
    EXPECT_LT(kept.rms, 1e-9 * um);
    EXPECT_NEAR(compare(of_slope(0.03), of_slope(0)).sq_true, um, 1e-3 * um);
    // The two maps differ by a plane alone, which the truth's form takes off: no deviation is left.
    EXPECT_NEAR(deviation_map(of_slope(0.03), of_slope(0), as_true).height(3, 3), 0, 1e-9 * um);
}

TEST(Comparison, OfFlatMapsHasNeitherCorrelationNorShift) {
    HeightMap tilted = truth_map(), other = truth_map(), constant = truth_map(), high = truth_map();
    for (int row = 0; row < tilted.rows(); ++row)
        for (int column = 0; column < tilted.columns(); ++column) {
            tilted.height(column, row) = 0.1 + 0.5 * tilted.x(column) - 0.2 * tilted.y(row);
            other.height(column, row) = 0.3 - 0.1 * tilted.x(column);
            constant.height(column, row) = 0.1;
            high.height(column, row) = 0.3;
        }
    const Band untreated{.form = {.kind = Form::Kind::none}};
    EXPECT_EQ(compare(constant, high, untreated).correlation, 0);
    EXPECT_NEAR(compare(constant, high, untreated).rms, 0.2, 1e-15);
    EXPECT_EQ(compare(constant, truth_map(), untreated).correlation, 0);
    for (const HeightMap& flat : {tilted, constant}) {
        EXPECT_EQ(compare(flat, other).correlation, 0);
        EXPECT_EQ(compare(flat, other).rms, 0);
        EXPECT_EQ(compare(flat, flat).correlation, 0);
        EXPECT_EQ(compare(flat, truth_map()).correlation, 0);
        EXPECT_TRUE(std::isnan(lateral_shift(flat, other).x));
        EXPECT_TRUE(std::isnan(lateral_shift(flat, flat).x));
    }
}

TEST(Comparison, TakesThePointsThatAreOnBothSpheres) {
    // The maps are caps of the radii 0.1 and 0.05 mm; points beyond the smaller one are flat and belong to neither
    // parameter.
    const auto cap = [](double radius) {
        HeightMap map{.height = Grid<double>(121, 121), .x0 = -0.06, .y0 = -0.06, .pitch_x = um, .pitch_y = um};
        for (int row = 0; row < map.rows(); ++row)
            for (int column = 0; column < map.columns(); ++column) {
                const double square = std::pow(map.x(column), 2) + std::pow(map.y(row), 2);
                map.height(column, row) = square < radius * radius ? std::sqrt(radius * radius - square) : std::nan("");
            }
        return map;
    };
    const HeightMap measured = cap(0.1), truth = cap(0.05);
    const Band sphere{.form = {.kind = Form::Kind::sphere}};
    const LevelledPair pair = levelled_pair(measured, truth, sphere);
    for (std::size_t k = 0; k < truth.height.values.size(); ++k)
        EXPECT_EQ(std::isnan(pair.measured.height.values[k]), std::isnan(pair.truth.height.values[k]));
    const Deviation deviation = compare(measured, truth, sphere);
    EXPECT_LT(deviation.rms, 1e-9);
    // The measured points are a disc of the radius 50 points, to within its edge of 314 points.
    EXPECT_NEAR(deviation.measured_share * 121 * 121, std::acos(-1) * 50 * 50, 314);
    EXPECT_GT(compare(measured, truth).rms, um); // the wrong twin: a plane leaves both caps
}

} // namespace
} // namespace vkfv::topography
