// The limits of a capability map are those of closed forms, and its nodes tell the errors that heights were given.
#include "core/mathematics/units.hpp"
#include "core/messages/json_text.hpp"
#include "measurement/capability/capability_documents.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <random>
#include <string>

namespace vkfv::measurement {
namespace {
namespace of_capability { // files of a unity build share the unnamed namespace

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double aperture = 0.28;

Conditions conditions(double pitch = 0.001) {
    return {.pixels = ImageSize::square(128),
            .pitch = pitch,
            .window = 7 * pitch,
            .resolution = 0.61 * 0.5876e-3 / aperture,
            .lowest = -0.03,
            .range = 0.06,
            .step = 0.001,
            .curve_deviation = 0.003,
            .blur = 0.01,
            .camera = true,
            .small = false,
            .seed = 1};
}

TestedInstrument instrument(const Conditions& of, double numerical_aperture, double object_index = 1) {
    return {.toml = "",
            .conditions = of,
            .numerical_aperture = numerical_aperture,
            .object_index = object_index,
            .identity_digest = "",
            .layout = ""};
}

LimitingProperties properties(const Conditions& of = conditions(), double numerical_aperture = aperture,
                              double noise = 20e-6) {
    return limiting_properties(instrument(of, numerical_aperture), topography::WindowShape::box, noise);
}

double bound(const std::string& key, double length, const LimitingProperties& own = properties()) {
    return limit_named(key).bound(own, length);
}

// Whether the wave is beyond the limit just outside of the bound, and not just inside.
void expect_edge(const std::string& key, const SurfaceWave& inside, const SurfaceWave& outside) {
    EXPECT_FALSE(limit_named(key).passed(properties(), inside)) << key;
    EXPECT_TRUE(limit_named(key).passed(properties(), outside)) << key;
}

TEST(CapabilityLimits, AreThoseOfClosedForms) {
    // sin x / x = 1/2 at x = 1.89549 = pi W / lambda.
    EXPECT_NEAR(bound("window", 0), pi / 1.89549 * 0.007, 2e-5);
    EXPECT_NEAR(bound("optics", 0), 1.2801e-3, 1e-7); // 0.61 x 0.5876 um / 0.28
    // tan(asin 0.28) = 0.28 / sqrt(1 - 0.0784) = 0.28 / 0.96; over 2 pi.
    EXPECT_NEAR(bound("slope", 0.02), 0.02 * (0.28 / 0.96) / (2 * pi), 1e-9);
    // A slope s = 2 pi A / lambda over 7 um has a standard deviation of 7 um s / sqrt(12): 3 um at s = 1.48461.
    EXPECT_NEAR(bound("relief", 0.02), 0.02 * 1.484615 / 6.283185, 1e-8);
    EXPECT_DOUBLE_EQ(bound("noise", 0.02), 60e-6);
    EXPECT_DOUBLE_EQ(bound("scan", 0.02), 0.024); // half of 60 um - 4 x 3 um
}

// NA = n sin(theta): in water the rim of the cone of an aperture of 0.5 has the slope 0.5 / sqrt(1.333^2 - 0.5^2), not
// the 0.577 of air.
TEST(CapabilityLimits, TheSlopeOfAMirrorIsThatOfTheConeInItsMedium) {
    constexpr double water = 1.333, slope = 0.404638, length = 0.02;
    const auto own = limiting_properties(instrument(conditions(), 0.5, water), topography::WindowShape::box, 20e-6);
    EXPECT_NEAR(2 * pi * bound("slope", length, own) / length, slope, 1e-6);
    // The aperture that a wave on the limit needs is the present one, and a steep wave's is below the index.
    const Limit& limit = limit_named("slope");
    EXPECT_NEAR(limit.needed(own, {.length = length, .amplitude = bound("slope", length, own)}), 0.5, 1e-12);
    const double steep = limit.needed(own, {.length = length, .amplitude = 10 * length});
    EXPECT_NEAR(steep, water * std::sin(std::atan(20 * pi)), 1e-12);
    EXPECT_THAT(limit.equation(own), HasSubstr("NA / n"));
}

// A Gaussian window has the standard deviation W / 5 and halves waves of W pi sqrt(2 / ln 2) / 5.
TEST(CapabilityLimits, AreThoseOfTheWindowsShape) {
    const auto own = limiting_properties(instrument(conditions(), aperture), topography::WindowShape::gaussian, 20e-6);
    EXPECT_NEAR(bound("window", 0, own), 0.007 * pi * std::sqrt(2 / std::log(2.0)) / 5, 3e-5);
    EXPECT_NEAR(bound("relief", 0.02, own), 0.003 * 0.02 / (2 * pi * 0.007 / 5), 1e-12);
    const Limit& relief = limit_named("relief");
    EXPECT_NEAR(relief.needed(own, {.length = 0.02, .amplitude = 2 * bound("relief", 0.02, own)}), 0.0035, 1e-12);
    EXPECT_THAT(relief.equation(own), HasSubstr("(5 λ)"));
    EXPECT_THAT(relief.equation(properties()), HasSubstr("√12"));
    EXPECT_THAT(limit_named("window").equation(own), HasSubstr("1.07 W"));
    EXPECT_THAT(limit_named("window").equation(properties()), HasSubstr("1.66 W"));
}

TEST(CapabilityLimits, ArePassedOnTheirOuterSide) {
    constexpr double amplitude = 1e-3, length = 0.02, in = 0.999, out = 1.001;
    for (const char* key : {"window", "optics"}) {
        expect_edge(key, {bound(key, 0) * out, amplitude}, {bound(key, 0) * in, amplitude});
    }
    for (const char* key : {"slope", "relief", "scan"}) {
        expect_edge(key, {length, bound(key, length) * in}, {length, bound(key, length) * out});
    }
    expect_edge("noise", {length, 60e-6 * out}, {length, 60e-6 * in});
    EXPECT_THAT(passed_limits(properties(), {length, 5e-4}), IsEmpty());
    EXPECT_THAT(keys_of(passed_limits(properties(), {0.008, 2.1e-3})), ElementsAre("window", "slope", "relief"));
    // Without a known noise nothing lies beyond its limit.
    EXPECT_FALSE(limit_named("noise").passed(properties(conditions(), aperture, surface::undefined), {length, 1e-9}));
}

// An instrument that has the needed property, and all else unchanged, has the wave on its limit: one with a little less
// does not reach it, one with a little more does.
TEST(CapabilityLimits, ANeededPropertyPutsTheWaveOnTheLimit) {
    const auto needed = [](const std::string& key, const SurfaceWave& wave) {
        EXPECT_TRUE(limit_named(key).passed(properties(), wave)) << key;
        return limit_named(key).needed(properties(), wave);
    };
    const auto expect_on_edge = [](const std::string& key, const SurfaceWave& wave, const LimitingProperties& better,
                                   const LimitingProperties& worse) {
        EXPECT_FALSE(limit_named(key).passed(better, wave)) << key;
        EXPECT_TRUE(limit_named(key).passed(worse, wave)) << key;
    };
    constexpr double less = 0.999, more = 1.001;
    const SurfaceWave fine{.length = 0.004, .amplitude = 1e-4};
    const double pixel = needed("window", fine);
    expect_on_edge("window", fine, properties(conditions(less * pixel)), properties(conditions(more * pixel)));

    const SurfaceWave finest{.length = 0.001, .amplitude = 1e-5};
    const auto with_aperture = [](double numerical_aperture) {
        auto own = conditions();
        own.resolution = 0.61 * 0.5876e-3 / numerical_aperture;
        return properties(own, numerical_aperture);
    };
    const double resolving = needed("optics", finest);
    expect_on_edge("optics", finest, with_aperture(more * resolving), with_aperture(less * resolving));

    const SurfaceWave steep{.length = 0.02, .amplitude = 5e-3};
    const double collecting = needed("slope", steep);
    EXPECT_NEAR(collecting, 0.843564, 1e-6); // s = pi / 2: s / sqrt(1 + s^2)
    expect_on_edge("slope", steep, with_aperture(more * collecting), with_aperture(less * collecting));

    const auto with_window = [](double window) {
        auto own = conditions();
        own.window = window;
        return properties(own);
    };
    const double window = needed("relief", steep);
    expect_on_edge("relief", steep, with_window(less * window), with_window(more * window));

    const SurfaceWave low{.length = 0.05, .amplitude = 30e-6};
    const double noise = needed("noise", low);
    expect_on_edge("noise", low, properties(conditions(), aperture, less * noise),
                   properties(conditions(), aperture, more * noise));

    const SurfaceWave high{.length = 0.5, .amplitude = 0.03};
    const auto with_range = [](double range) {
        auto own = conditions();
        own.range = range;
        return properties(own);
    };
    const double range = needed("scan", high);
    EXPECT_NEAR(range, 0.072, 1e-12); // 60 um and 4 x 3 um
    expect_on_edge("scan", high, with_range(more * range), with_range(less * range));
}

TEST(CapabilityMap, HasNodesInEqualRatiosFromTheWindowToHalfTheField) {
    const auto waves = waves_of_map(conditions(), 20e-6, 7, 6);
    ASSERT_EQ(waves.size(), 42u);
    EXPECT_DOUBLE_EQ(waves.front().length, 0.007);
    EXPECT_DOUBLE_EQ(waves.back().length, 0.064);
    EXPECT_DOUBLE_EQ(waves.front().amplitude, 20e-6);
    EXPECT_DOUBLE_EQ(waves.back().amplitude, 0.015);
    for (std::size_t k = 0; k + 1 < 6; ++k) { // to the four digits of an amplitude
        EXPECT_NEAR(waves[k + 1].amplitude / waves[k].amplitude, std::pow(0.015 / 20e-6, 0.2), 0.004);
        EXPECT_EQ(waves[k].length, waves[k + 1].length);
    }
    // A field of 128 windows leaves 30 windows.
    auto wide = conditions();
    wide.pixels = ImageSize::square(7 * 128);
    EXPECT_DOUBLE_EQ(waves_of_map(wide, 20e-6, 2, 2).back().length, 0.21);
    // The least amplitude stays within the map's largest one.
    EXPECT_DOUBLE_EQ(waves_of_map(conditions(), surface::undefined, 2, 2).front().amplitude, 15e-6);
    EXPECT_DOUBLE_EQ(waves_of_map(conditions(), 1, 2, 2).front().amplitude, 1.5e-3);
    // An estimate of the noise whose last digits differ names the same folders; another noise does not.
    const auto second = [](double noise) {
        return trial_of(conditions(), waves_of_map(conditions(), noise, 7, 6)[1], 1);
    };
    EXPECT_EQ(second(20.0001e-6).name, second(19.9999e-6).name);
    EXPECT_NE(second(20e-6).name, second(21e-6).name);
}

// Half a standard deviation of a focus curve, here 2 um, is a step that samples it. A small scan takes no smaller
// ones than it needs for the whole, and no larger ones, unless the scan has them.
TEST(SmallInstrument, IsThinnedWhereThatSufficesAndElseCut) {
    const auto tested = [](const std::string& start, const std::string& stop, const std::string& step) {
        const auto base = load_configuration(std::filesystem::path(VKFV_SOURCE_DIR) / "assets/stacks/paper_air.toml",
                                             {{"scan.z_start_um", start, ""},
                                              {"scan.z_stop_um", stop, ""},
                                              {"scan.z_step_um", step, ""},
                                              {"topography.peak_range_steps", "40", ""}});
        return tested_instrument(base, TestedField::small);
    };
    const auto read = [](const TestedInstrument& small) {
        auto configuration = read_configuration(
            TomlTable::parse(small.toml + "[specimen]\nkind = \"plane\"\nsize_mm = 1.0\n", "small.toml"));
        EXPECT_EQ(configuration.scan.value().positions().size(), 31u);
        return configuration;
    };
    // 661 images of 33 um: the whole scan, which holds a map, with an average along z as long as before.
    const auto thinned = tested("-24.0", "9.0", "0.05");
    EXPECT_NEAR(thinned.conditions.range, 0.033, 1e-9);
    EXPECT_NEAR(thinned.conditions.step, 0.0011, 1e-9);
    EXPECT_NEAR(thinned.conditions.middle(), -0.0075, 1e-9);
    EXPECT_NO_THROW(require_room_for_waves(thinned.conditions, "small.toml"));
    const auto topography = read(thinned).topography;
    EXPECT_NEAR(topography.smoothing_steps.value(), 20 * 0.05 / 1.1, 1e-9);
    EXPECT_EQ(topography.peak_range_steps, 3); // 40 steps of 0.05 um are two of 1.1 um; three are usual
    // 1001 images of 500 um: steps of half a focus curve's standard deviation, of the middle of the scan.
    const auto cut = tested("-100.0", "400.0", "0.5");
    EXPECT_NEAR(cut.conditions.step, 0.5 * cut.conditions.curve_deviation, 1e-9);
    EXPECT_NEAR(cut.conditions.range, 30 * cut.conditions.step, 1e-9);
    EXPECT_NEAR(cut.conditions.middle(), 0.150, 1e-9);
    EXPECT_EQ(read(cut).topography.peak_range_steps, std::lround(40 * 0.0005 / cut.conditions.step));
    // The upper end of this scan is found as -5e-18 mm, which is no length that a key takes.
    EXPECT_NEAR(read(tested("-30.3", "0.0", "0.3")).scan.value().positions().back(), 0, 1e-12);
    // 51 images whose steps are larger than that keep their steps.
    const auto coarse = tested("-100.0", "150.0", "5.0");
    EXPECT_NEAR(coarse.conditions.step, 0.005, 1e-9);
    EXPECT_NEAR(coarse.conditions.range, 0.150, 1e-9);
    EXPECT_EQ(read(coarse).topography.peak_range_steps, 40);
}

surface::HeightMap map_of(const std::function<double(double x, double y)>& height, double pitch = 0.001,
                          int side = 128) {
    const double first = -0.5 * (side - 1) * pitch;
    surface::HeightMap map{
        .height = Grid<double>(side, side), .x0 = first, .y0 = first, .pitch_x = pitch, .pitch_y = pitch};
    for (int row = 0; row < map.rows(); ++row) {
        for (int column = 0; column < map.columns(); ++column) {
            map.height(column, row) = height(map.x(column), map.y(row));
        }
    }
    return map;
}

struct Measured {
    double factor = 1;  // on the amplitude
    double missing = 0; // share of the points
    double wrong = 0;   // share of the points that are off by four uncertainties
    double offset = 0;  // mm, common to all heights
};

constexpr SurfaceWave wave{.length = 0.02, .amplitude = 1e-3};
constexpr double uncertainty = 1e-4; // mm

// Heights of the wave with an even share of missing and wrong points, and normal errors of a third of the uncertainty.
TrialResult trial(const Measured& measured) {
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0, uncertainty / 3);
    std::uniform_real_distribution<double> uniform;
    TrialResult result{.name = "wave",
                       .truth =
                           map_of([](double x, double) { return wave.amplitude * std::cos(2 * pi / wave.length * x); }),
                       .uncertainty = Grid<double>(128, 128, uncertainty),
                       .height_noise = 5e-5};
    result.heights = result.truth;
    for (double& height : result.heights.height.values) {
        const double draw = uniform(random);
        height = measured.factor * height + measured.offset + normal(random);
        if (draw < measured.missing) {
            height = surface::undefined;
        } else if (draw < measured.missing + measured.wrong) {
            height += (draw - measured.missing < 0.5 * measured.wrong ? 6 : -6) * uncertainty;
        }
    }
    StandardDimension amplitude{
        .measured = {.name = "amplitude", .rule = {}, .value = measured.factor * wave.amplitude},
        .truth = wave.amplitude};
    amplitude.measured.standard_error = 1e-6;
    amplitude.brightness_uncertainty = 2e-6;
    amplitude.window_uncertainty = 3e-6;
    result.dimensions = {amplitude};
    return result;
}

CapabilityNode node(const Measured& measured) {
    return node_of(conditions(), wave, trial(measured));
}

TEST(CapabilityNodes, TellTheErrorsOfTheHeights) {
    const CapabilityNode off = node({.factor = 0.97, .missing = 0.02, .wrong = 0.005, .offset = 0.002});
    EXPECT_NEAR(off.measured_share, 0.98, 0.004);
    EXPECT_NEAR(off.bias, -0.03, 1e-12);
    EXPECT_NEAR(off.bias_uncertainty, std::sqrt(1.0 + 4 + 9) * 1e-3, 1e-12); // scatter, brightness and window
    // Errors of the amplitude (3 % of it over sqrt 2), of the noise and of the wrong points; the offset does not count.
    const double wrong = 0.005 / 0.98 * std::pow(6 * uncertainty, 2);
    EXPECT_NEAR(off.rms_error, std::sqrt(std::pow(0.03 * 1e-3, 2) / 2 + std::pow(uncertainty / 3, 2) + wrong), 5e-6);
    EXPECT_NEAR(off.beyond, 0.005 / 0.98, 0.002);
    EXPECT_DOUBLE_EQ(off.noise, 5e-5);
    EXPECT_DOUBLE_EQ(off.uncertainty, uncertainty);
    EXPECT_TRUE(off.robust());
}

// Each condition alone decides: the twins break one of them.
TEST(CapabilityNodes, AreRobustIfBiasSharesAndUncertaintiesAllAre) {
    EXPECT_TRUE(node({.factor = 1, .missing = 0.04, .wrong = 0, .offset = 0}).robust());
    EXPECT_FALSE(node({.factor = 1, .missing = 0.06, .wrong = 0, .offset = 0}).robust());
    EXPECT_TRUE(node({.factor = 1, .missing = 0, .wrong = 0.007, .offset = 0}).robust());
    EXPECT_FALSE(node({.factor = 1, .missing = 0, .wrong = 0.014, .offset = 0}).robust());
    EXPECT_TRUE(node({.factor = 1.09, .missing = 0, .wrong = 0, .offset = 0}).robust());
    EXPECT_FALSE(node({.factor = 1.11, .missing = 0, .wrong = 0, .offset = 0}).robust());
    EXPECT_FALSE(node({.factor = 0.89, .missing = 0, .wrong = 0, .offset = 0}).robust());
    const CapabilityNode nothing = node({.factor = 1, .missing = 1, .wrong = 0, .offset = 0});
    EXPECT_EQ(nothing.measured_share, 0);
    EXPECT_FALSE(nothing.robust());
}

// A sinusoid has its own amplitude and wavelength as a rough surface, whatever its tilt. 32 points a period lose 0.16 %
// of the slope, and the pair that lacks at the end of the map, on a crest, has none, which adds 0.4 %.
TEST(CapabilitySpecimen, IsTheSinusoidOfItsRoughness) {
    constexpr double pitch = 0.0005;
    const auto rough = roughness_of(
        map_of([](double x, double y) { return 0.002 * std::cos(2 * pi * x / 0.016) + 0.1 * x - 0.2 * y; }, pitch));
    ASSERT_TRUE(rough);
    EXPECT_NEAR(rough->sq, 0.002 / std::sqrt(2.0), 1e-6);
    EXPECT_NEAR(rough->wave().amplitude, 0.002, 2e-6);
    EXPECT_NEAR(rough->wave().length, 0.016, 0.016 * 0.004);
    EXPECT_FALSE(roughness_of(map_of([](double x, double) { return 0.3 * x; })));
}

// The areal Gaussian S-filter (ISO 16610-61) leaves 2^-(L / lambda)^2 of a wave, for a nesting index L. Between the
// periods tried the share is linear in the logarithm of the period, which is off by less than 0.02 here.
TEST(CapabilitySpecimen, LosesWhatAnSFilterTakesOff) {
    constexpr double pitch = 0.00025, length = 0.004;
    const auto rough =
        roughness_of(map_of([](double x, double) { return 0.001 * std::cos(2 * pi * x / length); }, pitch));
    ASSERT_TRUE(rough);
    for (const double period : {0.001, 0.002, 0.004, 0.006}) {
        const double left = std::exp2(-std::pow(period / length, 2));
        EXPECT_NEAR(rough->kept_by(period).sq, left, 0.02) << period;
        EXPECT_NEAR(rough->kept_by(period).rms_slope, left, 0.02) << period;
    }
    EXPECT_NEAR(rough->period_keeping(0.9, &KeptRoughness::sq), length * std::sqrt(-std::log2(0.9)), 0.05 * length);
    EXPECT_NEAR(rough->period_keeping(0.5, &KeptRoughness::rms_slope), length, 0.03 * length);
}

// A short wave has most of the slopes and a long one most of the heights, so that Sdq is lost before Sq.
TEST(CapabilitySpecimen, LosesItsSlopesFirst) {
    constexpr double pitch = 0.00025;
    const auto rough = roughness_of(map_of(
        [](double x, double) { return 0.001 * std::cos(2 * pi * x / 0.032) + 0.0003 * std::cos(2 * pi * x / 0.003); },
        pitch, 256));
    ASSERT_TRUE(rough);
    const auto kept = rough->kept_by(0.008); // the short wave is gone: 2^-7
    EXPECT_NEAR(kept.sq, std::exp2(-1.0 / 16) / std::sqrt(1.09), 0.03);
    EXPECT_LT(kept.rms_slope, 0.4); // slopes of 1 / 32 beside 1 / 10, less what twelve points a period lose
    EXPECT_LT(rough->period_keeping(0.9, &KeptRoughness::rms_slope), 0.0015);
    EXPECT_GT(rough->period_keeping(0.9, &KeptRoughness::sq), 0.004);
}

Capability rough_capability(double sq, double rms_slope) {
    Capability capability{.program = "v", .title = "c", .properties = properties()};
    capability.instrument.conditions = conditions();
    capability.nodes = {node({.factor = 1, .missing = 0, .wrong = 0, .offset = 0}),
                        node({.factor = 0.5, .missing = 0, .wrong = 0, .offset = 0})};
    capability.nodes.back().wave = {.length = 0.005, .amplitude = 2e-3};
    capability.nodes.back().stack = "short";
    for (CapabilityNode& one : capability.nodes) {
        one.limits = keys_of(passed_limits(capability.properties, one.wave));
    }
    capability.specimen =
        RoughSpecimen{.sq = sq,
                      .rms_slope = rms_slope,
                      .kept = {{.period = 0.001, .sq = 1, .rms_slope = 1}, {.period = 0.1, .sq = 0.8, .rms_slope = 0}}};
    return capability;
}

TEST(CapabilitySpecimen, IsToldWhichInstrumentWouldMeasureIt) {
    // Sq 1 um and Sdq 1: a wavelength of 2 pi um, and a steepest slope of sqrt(2).
    const auto capability = rough_capability(1e-3, 1);
    const auto json = capability_json(capability);
    const auto& specimen = json.at("specimen");
    EXPECT_NEAR(specimen.at("wavelength_um").get<double>(), 6.283185, 1e-5);
    EXPECT_EQ(specimen.at("nearest_stack"), "short");
    ASSERT_EQ(specimen.at("beyond_limits").size(), 2u);
    const auto& window = specimen.at("beyond_limits").at(0);
    EXPECT_EQ(window.at("key"), "pixel_um");
    EXPECT_NEAR(window.at("present").get<double>(), 1, 1e-12);
    EXPECT_NEAR(window.at("needed").get<double>(), 6.283185 / (1.66 * 7), 1e-5);
    const auto& slope = specimen.at("beyond_limits").at(1);
    EXPECT_EQ(slope.at("limit"), "slope");
    EXPECT_NEAR(slope.at("needed").get<double>(), std::sqrt(2.0 / 3), 1e-9);
    // Half of the Sq's loss of 0.2 and a tenth of the Sdq come at 1 um times 100^0.5 and 100^0.1.
    const auto& kept = specimen.at("kept");
    const double lost = std::log(1.66 * 7) / std::log(100.0);
    EXPECT_NEAR(kept.at(0).at("share").get<double>(), 1 - 0.2 * lost, 1e-9);
    EXPECT_NEAR(kept.at(1).at("share").get<double>(), 1 - lost, 1e-9);
    EXPECT_NEAR(kept.at(0).at("period_um").get<double>(), 10, 1e-9);
    EXPECT_NEAR(kept.at(1).at("period_um").get<double>(), std::pow(100, 0.1), 1e-9);
    EXPECT_NEAR(kept.at(1).at("pixel_um").get<double>(), std::pow(100, 0.1) / (1.66 * 7), 1e-9);
    EXPECT_NEAR(kept.at(1).at("numerical_aperture").get<double>(), 0.61 * 0.5876 / std::pow(100, 0.1), 1e-9);
    const std::string page = capability_page(capability);
    EXPECT_THAT(page, HasSubstr("leave 46.7 % of the Sdq"));
    EXPECT_THAT(page, HasSubstr("1.85 times the magnification"));
    EXPECT_THAT(page, HasSubstr("is not measured robustly"));
    EXPECT_THAT(page, HasSubstr("contain the form"));
    EXPECT_THAT(page, HasSubstr("not traceable"));
    // A smooth one of long waves lies within all of them, and its neighbour is robust.
    const auto smooth = rough_capability(5e-4, 0.15);
    EXPECT_TRUE(capability_json(smooth).at("specimen").at("beyond_limits").empty());
    EXPECT_EQ(capability_json(smooth).at("specimen").at("nearest_stack"), "wave");
    EXPECT_THAT(remarks_of(smooth), testing::Contains(HasSubstr("is measured robustly")));
}

// Window and optics leave 47 % of the Sdq because the window is too long: the aperture suffices, and nothing is told of
// it. With a tenth of the aperture neither suffices.
TEST(CapabilitySpecimen, IsToldOnlyWhatDoesNotSuffice) {
    const auto sentence_of = [](const Capability& capability, const std::string& parameter) {
        for (const std::string& remark : remarks_of(capability)) {
            if (remark.starts_with("Window and optics") && remark.find("the " + parameter) != std::string::npos) {
                return remark;
            }
        }
        return std::string();
    };
    auto capability = rough_capability(1e-3, 1);
    EXPECT_THAT(sentence_of(capability, "Sq"), HasSubstr("of at most 0.861 µm in place of 1 µm, by 1.16 times"));
    EXPECT_THAT(sentence_of(capability, "Sq"), Not(HasSubstr("numerical aperture")));
    // The Sdq needs 0.61 x 0.5876 um / 1.585 um, within reach in air.
    auto coarse = capability;
    coarse.properties = properties(conditions(), 0.1 * aperture);
    coarse.properties.resolution *= 10;
    EXPECT_THAT(sentence_of(coarse, "Sdq"), HasSubstr("a numerical aperture of at least 0.226 in place of 0.028."));
    EXPECT_THAT(sentence_of(coarse, "Sdq"), HasSubstr("in place of 1 µm"));
    // A tenth of the periods: 0.1585 um need an aperture of 2.26.
    coarse.specimen->kept = {{.period = 1e-4, .sq = 1, .rms_slope = 1}, {.period = 0.01, .sq = 0.8, .rms_slope = 0}};
    EXPECT_THAT(sentence_of(coarse, "Sdq"), HasSubstr("which no objective in air has"));
    coarse.properties.object_index = 1.333;
    EXPECT_THAT(sentence_of(coarse, "Sdq"), HasSubstr("which no objective in a medium of index 1.33 has"));
}

// The map's wavelengths differ by 4 times, its amplitudes by 2.
TEST(CapabilitySpecimen, IsToldHowFarItLiesOffTheMap) {
    using testing::Contains;
    const auto near = rough_capability(1e-3, 1);
    EXPECT_DOUBLE_EQ(spacing_of_map(near, &SurfaceWave::length), 4);
    EXPECT_DOUBLE_EQ(spacing_of_map(near, &SurfaceWave::amplitude), 2);
    EXPECT_THAT(remarks_of(near), Not(Contains(HasSubstr("off the map"))));
    // Sq 0.1 um and Sdq 0.1 have the same wavelength, 2 pi um, and a tenth of the amplitude: 0.14 um beside 1 um.
    EXPECT_THAT(remarks_of(rough_capability(1e-4, 0.1)),
                Contains(HasSubstr("the sinusoid nearest to it has 7.07 times its amplitude.")));
}

bool has_nan(const std::string& text) {
    return std::ranges::any_of(std::array{">nan", "\"nan", " nan", "-nan"},
                               [&](const char* number) { return text.find(number) != std::string::npos; });
}

// A figure that is not known is null in the JSON and a dash on the page.
TEST(CapabilityDocuments, TellWhatIsNotKnown) {
    auto capability = rough_capability(1e-3, 1);
    capability.properties.noise = surface::undefined;
    auto lost = trial({.factor = 1, .missing = 0, .wrong = 0, .offset = 0});
    lost.dimensions.clear();
    capability.nodes.front() = node_of(conditions(), wave, lost);
    capability.specimen->kept = {{.period = 0.001, .sq = 0.5, .rms_slope = 0.5},
                                 {.period = 0.1, .sq = 0.4, .rms_slope = 0}};
    const auto json = nlohmann::json::parse(json_text(capability_json(capability)));
    EXPECT_TRUE(json.at("properties").at("noise_um").is_null());
    EXPECT_TRUE(json.at("limits").at(4).at("amplitude_at_one_window_um").is_null());
    EXPECT_TRUE(json.at("nodes").at(0).at("bias").is_null());
    EXPECT_TRUE(json.at("nodes").at(0).at("bias_uncertainty").is_null());
    EXPECT_FALSE(json.at("nodes").at(0).at("rms_error_um").is_null());
    EXPECT_TRUE(json.at("specimen").at("kept").at(0).at("period_um").is_null());
    EXPECT_TRUE(json.at("specimen").at("kept").at(1).at("pixel_um").is_null());
    const std::string page = capability_page(capability);
    EXPECT_FALSE(has_nan(page));
    EXPECT_THAT(page, HasSubstr("not even an S-filter of one pixel"));
    EXPECT_THAT(page, HasSubstr("the noise, and its limit, are not known"));
    EXPECT_THAT(page, HasSubstr("<td>A = 3 times the noise of a height</td><td>–</td>"));
    EXPECT_FALSE(has_nan(capability_map(capability)));
}

TEST(CapabilityDocuments, NameTheLimitsThatTheMapShows) {
    auto capability = rough_capability(1e-3, 1); // wavelengths from 5 to 20 um, amplitudes from 1 to 2 um
    EXPECT_THAT(capability_map(capability), HasSubstr("focus window"));
    EXPECT_THAT(capability_map(capability), HasSubstr("relief within the window"));
    EXPECT_THAT(capability_map(capability), Not(HasSubstr("measurement noise"))); // at 60 nm
    capability.properties.noise = 5e-4;                                           // 1.5 um
    EXPECT_THAT(capability_map(capability), HasSubstr("measurement noise"));
    capability.properties.noise = surface::undefined;
    EXPECT_THAT(capability_map(capability), Not(HasSubstr("measurement noise")));
}

TEST(CapabilityDocuments, TellThePartThatASmallMapSaw) {
    auto capability = rough_capability(1e-3, 1);
    const auto told = [&] {
        return std::ranges::any_of(remarks_of(capability), [](const std::string& remark) {
            return remark == "With --small the map was measured on 128 x 128 pixels and 60 µm of the scan, in steps of "
                             "1 µm; the limits of scan and field are those of this part.";
        });
    };
    EXPECT_FALSE(told());
    capability.instrument.conditions.small = true;
    EXPECT_TRUE(told());
}

} // namespace of_capability
} // namespace
} // namespace vkfv::measurement
