// [specimen.reflectance] and [illumination.field] are read, and focus is seen on flats by them alone.
#include "app/program.hpp"
#include "configuration/configuration.hpp"
#include "core/mathematics/units.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace vkfv::test {
namespace {

Configuration read(const std::string& text) {
    return read_configuration(TomlTable::parse(text, "/tmp/c.toml"));
}

TEST(ReflectanceMap, IsReadAndWrittenOut) {
    using Kind = specimen::Reflectance::Kind;
    const auto with = [](const std::string& lines) {
        return read(replaced(small_configuration, "[specimen.material]\n",
                             "[specimen.reflectance]\n" + lines + "[specimen.material]\n"));
    };
    EXPECT_FALSE(read(small_configuration).specimen->reflectance);
    const auto grating = with("kind = \"grating\"\nperiod_um = 8\nprofile = \"square\"\nangle_deg = 30\n"
                              "lowest = 0.1\nhighest = 0.9\nx_um = 2\ny_um = -3\n");
    ASSERT_TRUE(grating.specimen->reflectance);
    const specimen::Reflectance expected{.kind = Kind::grating,
                                         .lowest = 0.1,
                                         .highest = 0.9,
                                         .x = 0.002,
                                         .y = -0.003,
                                         .angle = 30 * radians_per_degree,
                                         .square = true,
                                         .period = 0.008};
    EXPECT_EQ(*grating.specimen->reflectance, expected);
    const auto star = with("kind = \"star\"\ncycles = 36\n");
    EXPECT_EQ(star.specimen->reflectance->cycles, 36);
    EXPECT_FALSE(star.specimen->reflectance->square);
    const auto noise = with("kind = \"noise\"\npitch_um = 0.5\ncorrelation_length_um = 2\nseed = 9\n");
    EXPECT_EQ(noise.specimen->reflectance->correlation_length, 0.002);
    EXPECT_EQ(noise.specimen->reflectance->mean, 0.5);
    EXPECT_EQ(noise.specimen->reflectance->seed, 9u);
    const auto board = with("kind = \"checkerboard\"\nside_um = 4\n");
    EXPECT_EQ(board.specimen->reflectance->side, 0.004);
    const auto image = with("kind = \"image\"\nfile = \"map.png\"\npitch_um = 0.5\n");
    EXPECT_EQ(image.specimen->reflectance->file.filename(), "map.png");
    for (const auto& configuration : {grating, star, noise, board, image}) {
        const auto again = read(configuration.canonical);
        EXPECT_EQ(again.canonical, configuration.canonical);
        EXPECT_EQ(again.identity, configuration.identity);
    }
    EXPECT_NE(with("kind = \"star\"\ncycles = 35\n").identity, star.identity);
    // A file counts by its bytes, not by its path (GeometryDigest).
    EXPECT_EQ(with("kind = \"image\"\nfile = \"other.png\"\npitch_um = 0.5\n").identity, image.identity);
}

// The depth of field is 7.5 um: heights of the printed flat scatter by a fraction of it, and at no point far. Without
// the print, the wrong twin, there is nothing to focus on.
TEST(ReflectanceMap, APrintedFlatIsMeasuredFlat) {
    const auto folder = fresh_folder("printed_flat");
    const auto example = (std::filesystem::path(VKFV_SOURCE_DIR) / "assets/stacks/printed_flat.toml").string();
    const auto results = [&](const std::string& name, std::vector<std::string> further) {
        std::vector<std::string> arguments = {"--stack", example, "--out",           name, "--quiet", "--rays",
                                              "262144",  "--set", "scan.z_step_um=2"};
        arguments.insert(arguments.end(), further.begin(), further.end());
        const auto result = run_program(arguments, folder);
        EXPECT_EQ(result.exit_code, 0) << result.standard_error;
        return nlohmann::json::parse(read_file(folder / name / "results.json"));
    };
    const auto printed = results("printed", {});
    EXPECT_GT(printed["measured_share"], 0.99);
    EXPECT_LT(printed["sq_measured_um"], 0.3);
    EXPECT_LT(printed["parameters"]["Sz_um"]["measured"], 3);
    const auto bare = results("bare", {"--set", "specimen.reflectance.standard_deviation=0"});
    EXPECT_LT(bare["measured_share"], 0.05);
}

TEST(LightField, IsReadAndWrittenOut) {
    const auto with = [](const std::string& lines) {
        return read(replaced(small_configuration, "[objective]\n", "[illumination.field]\n" + lines + "[objective]\n"));
    };
    EXPECT_FALSE(read(small_configuration).light_field);
    const auto grating = with("kind = \"grating\"\nperiod_um = 80\nangle_deg = 30\nlowest = 0.2\nfalloff = 0.1\n"
                              "falloff_radius_mm = 0.5\nbrightest_x_mm = 0.1\nbrightest_y_mm = -0.2\n");
    ASSERT_TRUE(grating.light_field);
    EXPECT_EQ(grating.light_field->pattern.kind, specimen::Reflectance::Kind::grating);
    EXPECT_EQ(grating.light_field->pattern.period, 0.08);
    EXPECT_EQ(grating.light_field->pattern.lowest, 0.2);
    EXPECT_NEAR(grating.light_field->falloff, 0.4, 1e-15); // 1/mm^2
    EXPECT_EQ(grating.light_field->brightest, glm::dvec2(0.1, -0.2));
    const auto even = with("kind = \"even\"\nfalloff = 0.3\nfalloff_radius_mm = 1\n");
    EXPECT_EQ(even.light_field->pattern.kind, specimen::Reflectance::Kind::even);
    for (const auto& configuration : {grating, even}) {
        const auto again = read(configuration.canonical);
        EXPECT_EQ(again.canonical, configuration.canonical);
        EXPECT_EQ(again.identity, configuration.identity);
    }
    EXPECT_NE(grating.identity, even.identity);
}

// A mirror-like flat is measured under a pattern that the illumination projects. Without it, the wrong twin, nothing is
// seen.
TEST(LightField, AMirrorIsMeasuredFlatByAProjectedPattern) {
    const auto folder = fresh_folder("smooth_flat");
    const auto example = (std::filesystem::path(VKFV_SOURCE_DIR) / "assets/stacks/projected_pattern.toml").string();
    const auto results = [&](const std::string& name, std::vector<std::string> further) {
        std::vector<std::string> arguments = {"--stack",
                                              example,
                                              "--out",
                                              name,
                                              "--quiet",
                                              "--rays",
                                              "65536",
                                              "--set",
                                              "scan.z_step_um=2",
                                              "--set",
                                              "detector.pixels=32"};
        arguments.insert(arguments.end(), further.begin(), further.end());
        const auto result = run_program(arguments, folder);
        EXPECT_EQ(result.exit_code, 0) << result.standard_error;
        return nlohmann::json::parse(read_file(folder / name / "results.json"));
    };
    const auto projected = results("projected", {});
    EXPECT_GT(projected["measured_share"], 0.98);
    EXPECT_LT(projected["sq_measured_um"], 0.3);
    const auto bare = results("bare", {"--set", "illumination.field.standard_deviation=0"});
    EXPECT_LT(bare["measured_share"], 0.1);
}

} // namespace
} // namespace vkfv::test
