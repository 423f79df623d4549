// [diffraction] blurs images after the trace and leaves the traced ones as they are.
#include "app/program.hpp"
#include "images/image_file.hpp"
#include "support/surface_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

namespace vkfv::test {
namespace {

using testing::HasSubstr;

double sum(const Grid<float>& image) {
    return std::accumulate(image.values.begin(), image.values.end(), 0.0);
}

double spread(const Grid<float>& image) {
    const double mean = sum(image) / static_cast<double>(image.values.size());
    double square = 0;
    for (const float value : image.values)
        square += (static_cast<double>(value) - mean) * (static_cast<double>(value) - mean);
    return std::sqrt(square / static_cast<double>(image.values.size()));
}

TEST(Diffraction, BlursBesideTheTracedImage) {
    const auto folder = fresh_folder("airy");
    write_file(folder / "c.toml", small_configuration);
    const auto run = [&](const std::string& out, const std::vector<std::string>& more) {
        std::vector<std::string> command = {"--image", "c.toml", "--z", "0", "--out", out, "--quiet"};
        command.insert(command.end(), more.begin(), more.end());
        const auto result = run_program(command, folder);
        EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    };
    run("a.tif", {"--set", "diffraction.model=none"});
    run("b.tif", {"--set", "diffraction.point_spread=airy"});
    EXPECT_EQ(read_file(folder / "a.tif"), read_file(folder / "b.tif"));
    const auto traced = images::read_image(folder / "b.tif");
    const auto blurred = images::read_image(folder / "b_diffracted.tif");
    // Each pixel is rounded to float.
    EXPECT_NEAR(sum(blurred) / sum(traced), 1, 1e-6);
    EXPECT_LT(spread(blurred), 0.9 * spread(traced));

    // The older name of the key says the same.
    run("d.tif", {"--set", "diffraction.model=airy"});
    EXPECT_EQ(read_file(folder / "d_diffracted.tif"), read_file(folder / "b_diffracted.tif"));
    // By default waves make the image, and no blur stands beside it.
    run("w.tif", {});
    EXPECT_FALSE(std::filesystem::exists(folder / "w_diffracted.tif"));
    const auto waves = images::read_image(folder / "w.tif");
    EXPECT_NEAR(sum(waves) / sum(traced), 1, 1e-6);
    EXPECT_LT(spread(waves), 0.95 * spread(traced));

    // A point spread function of one pixel is none.
    Grid<float> point(3, 3);
    point(1, 1) = 2;
    surface::write_tiff(folder / "point.tif", point);
    run("c.tif", {"--set", "diffraction.point_spread=file", "--set", "diffraction.file=point.tif", "--set",
                  "diffraction.pitch_um=0.001"});
    const auto same = images::read_image(folder / "c_diffracted.tif");
    for (std::size_t k = 0; k < same.values.size(); ++k)
        EXPECT_NEAR(same.values[k], traced.values[k], 1e-6 * sum(traced));
}

TEST(Diffraction, AWrongPointSpreadFunctionIsRefused) {
    const auto folder = fresh_folder("wrong");
    surface::write_tiff(folder / "dark.tif", Grid<float>(3, 3));
    write_file(folder / "c.toml", small_configuration);
    const auto run = [&](const std::vector<std::string>& settings) {
        std::vector<std::string> command = {"--image", "c.toml", "--z", "0", "--out", "a.tif", "--quiet"};
        for (const auto& setting : settings)
            command.insert(command.end(), {"--set", setting});
        const auto result = run_program(command, folder);
        EXPECT_EQ(result.exit_code, 2);
        return result.standard_error;
    };
    EXPECT_THAT(run({"diffraction.point_spread=file", "diffraction.file=dark.tif", "diffraction.pitch_um=0.1"}),
                HasSubstr("positive"));
    EXPECT_THAT(run({"diffraction.point_spread=file", "diffraction.file=none.tif", "diffraction.pitch_um=0.1"}),
                HasSubstr("none.tif"));
    EXPECT_THAT(run({"diffraction.point_spread=airy", "diffraction.pitch_um=0.1"}), HasSubstr("pitch_um"));
    EXPECT_THAT(run({"diffraction.point_spread=gauss"}), HasSubstr("airy"));
    EXPECT_THAT(run({"diffraction.point_spread=airy", "diffraction.model=airy"}), HasSubstr("beside model"));
    EXPECT_THAT(run({"diffraction.model=waves", "diffraction.cells=7"}), HasSubstr("even number"));
    EXPECT_THAT(run({"diffraction.model=none", "diffraction.cells=6"}), HasSubstr("cells"));
    EXPECT_THAT(run({"diffraction.model=waves", "trace.mode=nonsequential"}), HasSubstr("nonsequential"));
}

TEST(Diffraction, TakesTheCellsThatTheInstrumentAsksForOrThoseGiven) {
    const auto folder = fresh_folder("waves_cells");
    write_file(folder / "c.toml", small_configuration);
    const auto figures = [&](const std::vector<std::string>& settings) {
        std::vector<std::string> command = {"check", "c.toml", "--json"};
        command.insert(command.end(), settings.begin(), settings.end());
        const auto result = run_program(command, folder);
        EXPECT_EQ(result.exit_code, 0) << result.standard_error;
        return nlohmann::json::parse(result.standard_output);
    };
    const auto asked_for = figures({});
    EXPECT_EQ(asked_for["wave_cells"], 8);
    EXPECT_EQ(figures({"--set", "diffraction.cells=0"}), asked_for);
    const auto given = figures({"--set", "diffraction.cells=4"});
    EXPECT_EQ(given["wave_cells"], 4);
    EXPECT_LT(given["wave_memory_gib"], asked_for["wave_memory_gib"]);
    EXPECT_GT(given["wave_contrast_error_axis"], asked_for["wave_contrast_error_axis"]);
}

// With less memory a device sorts light more coarsely: other images, which a stack does not mix.
TEST(Diffraction, SaysThatMemoryForbidsTheFinePitch) {
    const auto folder = fresh_folder("waves_memory");
    write_file(folder / "c.toml", small_configuration);
    const auto run = [&](const std::string& memory) {
        return run_program({"--stack", "c.toml", "--out", "out", "--set", "diffraction.most_memory_gib=" + memory},
                           folder);
    };
    const auto coarse = run("0.0005");
    ASSERT_EQ(coarse.exit_code, 0) << coarse.standard_error;
    EXPECT_THAT(coarse.standard_error, HasSubstr("finer waves fold back"));
    const auto results = nlohmann::json::parse(read_file(folder / "out/results.json"));
    EXPECT_EQ(results["waves"]["cells"], 8);
    EXPECT_LT(results["waves"]["parts_per_pixel"], results["waves"]["parts_asked_for"]);
    EXPECT_GT(results["waves"]["folded_contrast"], 0.01);
    EXPECT_THAT(read_file(folder / "out/report.html"), HasSubstr("finer waves fold back"));
    EXPECT_THAT(run("0").standard_error, HasSubstr("parts_per_pixel"));
    const auto none = run("0.00001");
    EXPECT_NE(none.exit_code, 0);
    EXPECT_THAT(none.standard_error, HasSubstr("diffraction.cells"));
}

} // namespace
} // namespace vkfv::test
