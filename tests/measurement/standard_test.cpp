#include "measurement/surface/standard.hpp"

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
