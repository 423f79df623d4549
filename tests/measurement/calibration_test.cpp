// The characteristics of a virtual calibration, on heights with known errors in place of traced ones.
#include "core/mathematics/units.hpp"
#include "measurement/calibration/characteristic.hpp"
#include "measurement/calibration/standards.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <regex>

namespace vkfv::measurement {
namespace {

Conditions conditions() {
    return {.pixels = ImageSize::square(128),
            .pitch = 0.001,
            .window = 0.007,
            .resolution = 0.0012,
            .lowest = -0.03,
            .range = 0.06,
            .step = 0.001,
            .curve_deviation = 0.003,
            .blur = 0.006,
            .camera = true,
            .small = false,
            .seed = 1};
}

const CertificateFigure& figure(const Findings& findings, const std::string& key) {
    const auto found = std::ranges::find(findings.figures, key, &CertificateFigure::key);
    if (found == findings.figures.end()) {
        throw std::out_of_range("no figure " + key);
    }
    return *found;
}

std::vector<Trial> trials_of(const Characteristic& characteristic) {
    std::vector<std::string> remarks;
    auto trials = characteristic.trials(conditions(), remarks);
    EXPECT_TRUE(remarks.empty());
    EXPECT_FALSE(trials.empty());
    return trials;
}

surface::HeightMap map_of(const std::function<double(double x, double y)>& height) {
    const auto c = conditions();
    surface::HeightMap map{.height = Grid<double>(c.pixels.columns, c.pixels.rows),
                           .x0 = -0.0635,
                           .y0 = -0.0635,
                           .pitch_x = c.pitch,
                           .pitch_y = c.pitch};
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns(); ++column) {
            map.height(column, row) = height(map.x(column), map.y(row));
        }
    }
    return map;
}

TEST(Calibration, NoiseIsThatOfTheHeightsAndNotTheirForm) {
    const auto characteristic = measurement_noise();
    constexpr double sigma = 20e-6; // mm
    std::mt19937 random(4);
    std::normal_distribution<double> normal(0, sigma);
    std::vector<TrialResult> results;
    for (const Trial& trial : trials_of(characteristic)) {
        // The form, 25 times the noise, is common to all measurements; each has a tilt of its own.
        const double tilt = 1e-3 * normal(random) / sigma;
        results.push_back({.name = trial.name, .heights = map_of([&](double x, double y) {
                                                   return 500e-6 * std::sin(60 * x) * std::cos(50 * y) + tilt * x +
                                                          normal(random);
                                               })});
    }
    const auto findings = characteristic.evaluate(conditions(), results);
    const auto& raw = figure(findings, "N_M_at_50_percent_nm");
    EXPECT_NEAR(raw.value, 20, 3 * raw.standard_uncertainty + 0.1);
    EXPECT_LT(raw.standard_uncertainty, 0.5);
    // White noise under the S-filter: 1 / sqrt(2 pi) over the filter's standard deviation in pixels, L / sqrt(2 pi)
    // times sqrt(ln 2 / pi) for a nesting index L; sigma times pitch / (sqrt(4 pi) s). 17.5 pixels: s = 3.28.
    const double s = conditions().s_filter() / conditions().pitch * std::sqrt(std::log(2.0) / pi / (2 * pi));
    EXPECT_NEAR(figure(findings, "N_M_filtered_at_50_percent_nm").value, 20 / (std::sqrt(4 * pi) * s), 0.25);
    EXPECT_NEAR(raw.expanded_uncertainty() / raw.standard_uncertainty, 2.262, 1e-3); // Student's, 9 degrees of freedom
}

TEST(Calibration, FlatnessFallsToTheFormAsPlacesAreAdded) {
    const auto characteristic = flatness_deviation();
    constexpr double sag = 300e-6; // mm, from the middle to the corner
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, 50e-6);
    const auto with_sag = [&](double depth) {
        std::vector<TrialResult> results;
        for (const Trial& trial : trials_of(characteristic)) {
            results.push_back({.name = trial.name, .heights = map_of([&](double x, double y) {
                                                       return depth * (x * x + y * y) / (2 * 0.0635 * 0.0635) +
                                                              normal(random);
                                                   })});
        }
        return characteristic.evaluate(conditions(), results);
    };
    const auto curved = with_sag(sag);
    const double found = figure(curved, "z_FLT_nm").value, alone = figure(curved, "z_FLT_by_scatter_nm").value;
    EXPECT_NEAR(found, 300, alone + 0.1 * 300);
    EXPECT_LT(alone, 30);
    // Without a form the range is that of the scatter.
    const auto flat = with_sag(0);
    EXPECT_NEAR(figure(flat, "z_FLT_nm").value / figure(flat, "z_FLT_by_scatter_nm").value, 1, 0.25);
    // Ranges of fewer places are larger, as the square root of the number.
    EXPECT_GT(flat.tables.front().rows.front()[1], 1.5 * flat.tables.front().rows.back()[1]);
}

double depth_in(const Trial& trial) { // mm
    std::smatch found;
    if (!std::regex_search(trial.specimen, found, std::regex("\ndepth_um = ([0-9.e+-]+)"))) {
        throw std::out_of_range("no depth in " + trial.specimen);
    }
    return std::stod(found[1]) / um_per_mm;
}

Findings amplification_of(const std::function<double(double depth)>& measured, double scatter, unsigned seed) {
    const auto characteristic = vertical_amplification();
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, scatter);
    std::vector<TrialResult> results;
    for (const Trial& trial : trials_of(characteristic)) {
        StandardDimension depth{.measured = {.name = "groove depth", .rule = {}}, .truth = depth_in(trial)};
        depth.measured.value = measured(depth.truth) + normal(random);
        depth.measured.standard_error = scatter;
        results.push_back({.name = trial.name, .dimensions = {depth}});
    }
    return characteristic.evaluate(conditions(), results);
}

// A groove of a lens of high aperture: rays from the edge of the bottom's middle third pass below the wall's upper edge
// at every angle of the cone. In a wide field the groove is as deep as the scan allows, in a narrow one shallower, with
// a remark.
TEST(Calibration, AGrooveLeavesTheLightConeOfItsBottomWhole) {
    const auto value_of = [](const std::string& toml, const std::string& key) {
        std::smatch match;
        return std::regex_search(toml, match, std::regex(key + " = ([-+.e0-9]+)")) ? std::stod(match[1]) * 1e-3 : -1;
    };
    auto c = conditions();
    c.blur = 0.5 * c.range * 2; // NA 0.894
    for (const int side : {256, 1024}) {
        c.pixels = ImageSize::square(side);
        for (const auto& characteristic : {vertical_amplification(), repeatability()}) {
            std::vector<std::string> remarks;
            double deepest = 0;
            for (const Trial& trial : characteristic.trials(c, remarks)) {
                const double width = value_of(trial.specimen, "width_um"), depth = value_of(trial.specimen, "depth_um");
                EXPECT_LE(2 * (depth + 2 * c.curve_deviation), width / 3 - 0.5 * c.window + 1e-9);
                EXPECT_LE(2.6 * width, c.field() + 1e-9);
                deepest = std::max(deepest, depth);
            }
            const bool narrow = side == 256;
            const double wished = (characteristic.name == "alpha_z" ? 0.9 : 0.5) * c.usable_range();
            EXPECT_GT(deepest, 0.1 * wished);
            EXPECT_EQ(deepest < 0.99 * wished, narrow) << characteristic.name << ' ' << deepest;
            EXPECT_EQ(remarks.size(), narrow ? 1u : 0u);
        }
    }
}

// The middle of a scan from -36 to 36 um is found as 7e-18 mm, which is no length that a key takes.
TEST(Calibration, AStandardInTheMiddleOfASymmetricScanIsAtZero) {
    EXPECT_EQ(um(6.9388939e-18), "0");
    EXPECT_EQ(um(-6.9388939e-18), "0");
    EXPECT_EQ(um(-0.0125), "-12.5");
}

// The width of a groove that the field holds is chosen by its depth. The depth that follows from this width again may
// be less by a rounding, as at one depth in fifteen here: the groove then has its depth, and no remark says otherwise.
TEST(Calibration, AGrooveIsNoShallowerByRounding) {
    auto c = conditions();
    c.pixels = ImageSize::square(1 << 14);
    c.blur = 0.5 * c.range * 2;
    int rounded = 0;
    for (int k = 1; k <= 1000; ++k) {
        const double wished = 3e-3 + 4.1e-5 * k;
        const Groove groove = groove_of(c, wished, 0.4);
        EXPECT_EQ(groove.depth, wished) << k;
        const double blurred = 0.5 * c.window + 2 * c.curve_deviation * c.cone_slope();
        rounded += (groove.width / 3 - blurred) / c.cone_slope() < wished ? 1 : 0;
        std::vector<std::string> remarks;
        remark_shallower(c, {.width = groove.width, .depth = std::nextafter(wished, 0.0)}, wished, remarks);
        EXPECT_TRUE(remarks.empty());
        remark_shallower(c, {.width = groove.width, .depth = (1 - 1e-6) * wished}, wished, remarks);
        EXPECT_EQ(remarks.size(), 1u);
    }
    EXPECT_GT(rounded, 10);
}

// An error of six standard uncertainties is found within its expanded uncertainty, which leaves one of the scale's true
// values out in one case of twenty: of 200 seeds in 10, with a standard deviation of 3.1.
TEST(Calibration, AnErrorOfTheScaleIsFound) {
    int found = 0, excluded = 0, excluded_by_chance = 0;
    constexpr int seeds = 200, most_outside = 20;
    const auto lies_outside = [](const CertificateFigure& alpha, double value) {
        return std::abs(alpha.value - value) > alpha.expanded_uncertainty();
    };
    for (unsigned seed = 1; seed <= seeds; ++seed) {
        const auto with_error = amplification_of([](double depth) { return 1.002 * depth; }, 20e-6, seed);
        const auto& alpha = figure(with_error, "alpha_z");
        EXPECT_LT(alpha.expanded_uncertainty(), 1.4e-3);
        found += lies_outside(alpha, 1.002) ? 0 : 1;
        excluded += lies_outside(alpha, 1) ? 1 : 0;
        const auto without = amplification_of([](double depth) { return depth; }, 20e-6, seed);
        excluded_by_chance += lies_outside(figure(without, "alpha_z"), 1) ? 1 : 0;
    }
    EXPECT_GE(found, seeds - most_outside);
    EXPECT_GE(excluded, seeds - most_outside);
    EXPECT_LE(excluded_by_chance, most_outside);
    EXPECT_GT(excluded_by_chance, 0); // an uncertainty that is too large never excludes the truth
}

// For grooves about the middle of the scan a cubic error a (z / h)^3 of the scale changes a depth d by 2 a (d / 2h)^3.
// The test computes anew, for the seven depths, how far this change departs from a least-squares line with an offset.
TEST(Calibration, ACubicErrorOfTheScaleIsItsDeviationFromTheLine) {
    constexpr double a = 200e-6; // mm, at the ends of the usable range
    const double half = 0.5 * conditions().usable_range();
    const auto cubic = [&](double depth) { return depth + 2 * a * std::pow(depth / (2 * half), 3); };
    const auto findings = amplification_of(cubic, 1e-9, 1);
    std::vector<double> x, y;
    for (int k = 0; k < 7; ++k) {
        x.push_back(0.05 + 0.85 * k / 6);
        y.push_back(2 * std::pow(x.back(), 3));
    }
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0, most = 0;
    for (int k = 0; k < 7; ++k) {
        mean_x += x[k] / 7;
        mean_y += y[k] / 7;
    }
    for (int k = 0; k < 7; ++k) {
        xx += (x[k] - mean_x) * (x[k] - mean_x);
        xy += (x[k] - mean_x) * (y[k] - mean_y);
    }
    for (int k = 0; k < 7; ++k) {
        most = std::max(most, std::abs(y[k] - mean_y - xy / xx * (x[k] - mean_x)));
    }
    EXPECT_NEAR(most, 0.32, 0.005);
    EXPECT_NEAR(figure(findings, "l_z_nm").value, 200 * most, 0.01);
    EXPECT_LT(figure(amplification_of([](double depth) { return depth; }, 1e-9, 1), "l_z_nm").value, 0.01);
}

TEST(Calibration, RepeatabilityAndReproducibilityArePartedAsTheyWereAdded) {
    const auto characteristic = repeatability();
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    constexpr double within = 10e-6, between = 40e-6; // mm
    std::vector<TrialResult> results;
    double place_error = 0;
    const auto trials = trials_of(characteristic);
    for (std::size_t k = 0; k < trials.size(); ++k) {
        place_error = trials[k].name.ends_with("repeat_00") ? between * normal(random) : place_error;
        StandardDimension depth{.measured = {.name = "groove depth", .rule = {}}, .truth = 0.01};
        depth.measured.value = 0.01 + place_error + within * normal(random);
        results.push_back({.name = trials[k].name, .dimensions = {depth}});
    }
    const auto findings = characteristic.evaluate(conditions(), results);
    const auto& repeated = figure(findings, "repeatability_nm");
    const auto& reproduced = figure(findings, "reproducibility_nm");
    EXPECT_NEAR(repeated.value, 10, 3 * repeated.standard_uncertainty);
    EXPECT_NEAR(reproduced.value, std::hypot(10, 40), 3 * reproduced.standard_uncertainty);
    EXPECT_GT(reproduced.value, 2 * repeated.value);
}

TEST(Calibration, ASlopeIsLimitedWhereItsPointsAreWrongOrMissing) {
    const auto characteristic = slope_limit();
    std::vector<TrialResult> results;
    double tilt = 0;
    for (const Trial& trial : trials_of(characteristic)) {
        const double slope = std::tan(tilt * radians_per_degree);
        TrialResult result{.name = trial.name,
                           .truth = map_of([&](double x, double) { return slope * x; }),
                           .uncertainty = Grid<double>(128, 128, 1e-4)};
        result.heights = result.truth;
        if (tilt > 32) { // every tenth point is off by four uncertainties
            for (std::size_t k = 0; k < result.heights.height.values.size(); k += 10) {
                result.heights.height.values[k] += 4e-4;
            }
        }
        results.push_back(std::move(result));
        tilt += 5;
    }
    const auto findings = characteristic.evaluate(conditions(), results);
    EXPECT_EQ(figure(findings, "slope_limit_deg").value, 30);
    EXPECT_NEAR(figure(findings, "most_wrong_percent").value, 10, 1);
}

// Pixels whose columns stand at 90.1 degrees to the rows look at (-tan(0.1 degrees) y, y), as detector.shear_deg = 0.1
// has them do, and the certificate tells this angle.
TEST(Calibration, ASkewOfTheInstrumentsAxesIsFoundWithItsSign) {
    constexpr double shear_deg = 0.1;
    const auto characteristic = lateral_mapping();
    auto own = conditions();
    own.window = 0.005;
    const double wave = 2 * pi / (4 * own.window);
    std::vector<std::string> remarks;
    std::vector<TrialResult> results;
    for (const Trial& trial : characteristic.trials(own, remarks)) {
        results.push_back({.name = trial.name, .heights = map_of([&](double x, double y) {
                                                   const double seen = x - std::tan(shear_deg * radians_per_degree) * y;
                                                   return 1e-3 * (std::cos(wave * seen) + std::cos(wave * y));
                                               })});
    }
    ASSERT_FALSE(results.empty());
    const auto findings = characteristic.evaluate(own, results);
    EXPECT_NEAR(figure(findings, "perpendicularity_deg").value, shear_deg, 0.01 * shear_deg);
    EXPECT_NEAR(figure(findings, "alpha_x").value, 1, 1e-4);
}

// The transfer of a box window of W at a period P is sinc(W / P), which is one half at P = 1.657 W. Pixels much finer
// than the optics resolve meet it too.
TEST(Calibration, TheResolutionIsThatOfAKnownTransfer) {
    struct Case {
        double resolution; // mm
        double window;     // pixels
    };
    const auto characteristic = lateral_resolution();
    for (const Case& one : {Case{0.0012, 7}, Case{0.016, 32}}) {
        auto c = conditions();
        c.pixels = ImageSize::square(324);
        c.resolution = one.resolution;
        std::vector<std::string> remarks;
        std::vector<TrialResult> results;
        for (const Trial& trial : characteristic.trials(c, remarks)) {
            std::smatch found;
            TrialResult result{.name = trial.name};
            if (std::regex_search(trial.name, found, std::regex("period_([0-9]+)_px"))) {
                const double x = pi * one.window / std::stod(found[1]);
                result.dimensions.push_back(
                    {.measured = {.name = "amplitude", .rule = {}, .value = 1e-3 * std::sin(x) / x}, .truth = 1e-3});
            } else {
                result.heights = result.truth = map_of([](double, double) { return 0.0; });
            }
            results.push_back(std::move(result));
        }
        EXPECT_TRUE(remarks.empty());
        const auto findings = characteristic.evaluate(c, results);
        EXPECT_NEAR(figure(findings, "D_LIM_um").value, 1.657 * one.window, 0.1 / 7 * one.window);
    }
}

} // namespace
} // namespace vkfv::measurement
