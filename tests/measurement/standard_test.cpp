#include "measurement/surface/standard.hpp"

#include "core/mathematics/units.hpp"
#include "measurement/evaluation/brightness_warnings.hpp"
#include "measurement/surface/surface_measurement.hpp"
#include "surface_files/surface_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace vkfv::measurement {
namespace {

// A groove of 40 um along y, this deep, on a slope.
surface::HeightMap groove_of(double depth) {
    surface::HeightMap map{
        .height = Grid<double>(160, 40), .x0 = -0.0795, .y0 = -0.0195, .pitch_x = 0.001, .pitch_y = 0.001};
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            map.height(column, row) = (std::abs(map.x(column)) < 0.02 ? -depth : 0) + 0.01 * map.x(column);
    return map;
}

const dimensions::Groove groove{.frame = {}, .width = 0.04, .depth = 0.005};

TEST(StandardDimensions, TellNominalTrueAndMeasuredInTheirUnit) {
    const auto found = standard_dimensions(groove, groove_of(0.0052), groove_of(0.00505));
    const auto json = json_of(found);
    ASSERT_EQ(json.size(), 3u);
    EXPECT_EQ(json[0]["name"], "groove depth");
    EXPECT_EQ(json[0]["unit"], "um");
    EXPECT_NEAR(json[0]["nominal"].get<double>(), 5, 1e-9);
    EXPECT_NEAR(json[0]["true"].get<double>(), 5.05, 1e-9);
    EXPECT_NEAR(json[0]["measured"].get<double>(), 5.2, 1e-9);
    EXPECT_NEAR(json[0]["deviation"].get<double>(), 0.2, 1e-9);
    EXPECT_NEAR(json[0]["error"].get<double>(), 0.15, 1e-9);
    EXPECT_EQ(json[0]["profiles"], 40);
    EXPECT_NE(dimensions_text(found).find("5.2 um"), std::string::npos);
}

topography::FocusWindow seven_points() {
    return {7, topography::WindowShape::box};
}

// Upper levels and ground each come nearer to the mean by the uncertainty of a height.
TEST(StandardDimensions, AreUncertainByBrightnessAsTheirHeightsAre) {
    const topography::BrightnessPull pull{.side = 160, .blocks = Grid<double>(1, 1, 0.0002)};
    const auto found = standard_dimensions(groove, groove_of(0.0052), groove_of(0.00505),
                                           FocusEffects{.pull = &pull, .window = seven_points()});
    EXPECT_NEAR(json_of(found)[0]["brightness_uncertainty"].get<double>(), 0.4, 1e-9);
    EXPECT_NEAR(json_of(found)[0]["measured"].get<double>(), 5.2, 1e-9);
    EXPECT_NE(dimensions_text(found).find("+- 0.4 by brightness that changes with focus"), std::string::npos);
    const topography::BrightnessPull none;
    const auto sure = standard_dimensions(groove, groove_of(0.0052), groove_of(0.00505),
                                          FocusEffects{.pull = &none, .window = seven_points()});
    EXPECT_EQ(sure[0].brightness_uncertainty, 0);
    const auto unknown = standard_dimensions(groove, groove_of(0.0052), groove_of(0.00505));
    const auto written = nlohmann::json::parse(json_of(unknown).dump()); // as results.json has it
    EXPECT_TRUE(written[0]["brightness_uncertainty"].is_null());
    EXPECT_TRUE(written[0]["window_uncertainty"].is_null());
    EXPECT_EQ(dimensions_text(unknown).find("brightness"), std::string::npos);
}

// A window of 7 points leaves sin(7 x) / (7 sin(x)) of a wave, with x = pi / 40 for 40 points a period, and another one
// as much again. The levels of a groove lie farther than a window from its walls.
TEST(StandardDimensions, AreUncertainByWhatTheWindowAverages) {
    const double x = pi / 40, left = std::sin(7 * x) / (7 * std::sin(x));
    surface::HeightMap wave{
        .height = Grid<double>(160, 40), .x0 = -0.0795, .y0 = -0.0195, .pitch_x = 0.001, .pitch_y = 0.001};
    for (int row = 0; row < wave.rows(); ++row) {
        for (int column = 0; column < wave.columns(); ++column) {
            wave.height(column, row) = 0.004 * left * std::cos(2 * x * column);
        }
    }
    wave.height(30, 20) = surface::undefined;
    const topography::BrightnessPull none;
    const FocusEffects effects{.pull = &none, .window = seven_points()};
    const auto found =
        standard_dimensions(dimensions::Sinusoid{.frame = {}, .amplitude = 0.004, .period = 0.04}, wave, {}, effects);
    const double lost = 0.004 * (1 - left);
    EXPECT_NEAR(found[0].measured.value, 0.004 - lost, 1e-6);
    EXPECT_NEAR(found[0].window_uncertainty, lost, 0.1 * lost) << "the window's part is told";
    EXPECT_NEAR(standard_dimensions(groove, groove_of(0.005), {}, effects)[0].window_uncertainty, 0, 1e-7);
}

TEST(StandardDimensions, ThoseThatBrightnessMakesUncertainAreWarnedOf) {
    Evaluation evaluation;
    EXPECT_TRUE(warnings_of_brightness(evaluation).empty());
    evaluation.dimensions = {{.measured = {.name = "amplitude", .rule = {}, .value = 0.0038, .standard_error = 2e-5},
                              .brightness_uncertainty = 2.1e-4},
                             {.measured = {.name = "period", .rule = {}, .value = 0.04, .standard_error = 2e-5},
                              .brightness_uncertainty = 3e-5},
                             {.measured = {.name = "mean", .rule = {}, .value = 0.04, .standard_error = 2e-5}}};
    const auto warnings = warnings_of_brightness(evaluation);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].code, "brightness-changes-with-focus");
    EXPECT_NE(warnings[0].sentence.find("(amplitude, 0.21 um)"), std::string::npos) << warnings[0].sentence;
}

TEST(StandardDimensions, WhatWasNotMeasuredIsNull) {
    auto gone = groove_of(0.005);
    for (double& z : gone.height.values)
        z = surface::undefined;
    const auto found = standard_dimensions(groove, gone, groove_of(0.005));
    const auto text = json_of(found).dump();
    EXPECT_NE(text.find("\"measured\":null"), std::string::npos);
    EXPECT_NE(text.find("\"true\":5."), std::string::npos);
    EXPECT_NE(dimensions_text(found).find("not measured"), std::string::npos);
}

TEST(StandardDimensions, AreFoundInAFileBeforeItsFormIsRemoved) {
    const auto file = std::filesystem::temp_directory_path() / "vkfv_standard_test_groove.x3p";
    {
        const std::string bytes = surface::surface_bytes(file, groove_of(0.005), {});
        std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
    SurfaceRequest request;
    request.file = file;
    request.sought = dimensions::Sought::groove;
    const auto figures = measure_surface(request);
    ASSERT_EQ(figures.dimensions.size(), 3u);
    EXPECT_NEAR(figures.dimensions[0].measured.value, 0.005, 1e-6);
    EXPECT_NEAR(figures.dimensions[2].measured.value, 0.04, 1e-3); // walls of one point
    EXPECT_TRUE(surface_json(figures, file).contains("dimensions"));
    request.sought.reset();
    EXPECT_FALSE(surface_json(measure_surface(request), file).contains("dimensions"));
    std::filesystem::remove(file);
}

} // namespace
} // namespace vkfv::measurement
