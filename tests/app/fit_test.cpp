// vkfv fit finds a number with which a stack was made, goes on where it ended, and keeps statistics alone.
#include "app/program.hpp"
#include "core/files/file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace vkfv::test {
namespace {
namespace of_fit { // files of a unity build share the unnamed namespace

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

// A rough plane, 48 x 48 pixels, five images.
std::string rough_plane() {
    std::string text = replaced(small_configuration, "size_mm = 0.16\npixels = 8", "size_mm = 0.48\npixels = 48");
    text = replaced(text, "field_stop_radius_mm = 0.2", "field_stop_radius_mm = 1.0");
    text = replaced(text, "kind = \"step\"\nsize_mm = 0.2\nheight_um = 2.0", "kind = \"plane\"\nsize_mm = 0.2");
    text = replaced(text, "noise_um = 0.1\nkernel_um = 1.0", "sq_um = 1.0\nkernel_um = 2.0");
    text = replaced(text, "z_start_um = -2.0\nz_stop_um = 2.0\nz_step_um = 1.0",
                    "z_start_um = -8.0\nz_stop_um = 8.0\nz_step_um = 4.0");
    text = replaced(text, "rays = 2000\nseed = 1\nestimator = \"forward\"",
                    "rays = 1e4\nseed = 1\nestimator = \"backward\"");
    return text + "[diffraction]\nmodel = \"none\"\n";
}

std::vector<std::string> fit_of(const std::string& stack) {
    return {"fit",   stack, "--free", "specimen.material.g", "--start", "specimen.material.g=0.6", "--replicates", "8",
            "--out", "out", "--quiet"};
}

struct Interval {
    double low, high;
    bool holds(double value) const { return low <= value && value <= high; }
};

Interval interval_in(const fs::path& file) {
    const auto fit = json::parse(read_file(file));
    const auto& parameter = fit.at("parameters").at(0);
    EXPECT_TRUE(parameter.at("told").get<bool>());
    return {parameter.at("low").get<double>(), parameter.at("high").get<double>()};
}

TEST(Fit, FindsTheNumberOfAStackAndGoesOnWhereItEnded) {
    const auto folder = fresh_folder("fit");
    write_file(folder / "c.toml", rough_plane());
    constexpr double known = 0.7, another = 0.5;
    for (const auto& [name, g] : {std::pair("known", known), std::pair("another", another)}) {
        const auto stack = run_program(
            {"stack", "c.toml", "--out", name, "--set", fmt::format("specimen.material.g={}", g), "--quiet"}, folder);
        ASSERT_EQ(stack.exit_code, 0) << stack.standard_error;
    }
    const auto first = run_program(fit_of("known/"), folder);
    ASSERT_EQ(first.exit_code, 0) << first.standard_error;
    EXPECT_THAT(first.standard_output, testing::StartsWith("The model "));
    EXPECT_THAT(first.standard_output, HasSubstr("specimen.material.g:"));
    EXPECT_THAT(first.standard_output, HasSubstr("not traceable"));
    const Interval interval = interval_in(folder / "out/fit.json");
    EXPECT_TRUE(interval.holds(known)) << interval.low << " to " << interval.high;
    EXPECT_FALSE(interval.holds(another)) << interval.low << " to " << interval.high;
    const auto page = read_file(folder / "out/fit.html");
    EXPECT_THAT(page, HasSubstr("Cramér-Rao bound"));
    EXPECT_THAT(page, HasSubstr("not traceable"));
    EXPECT_FALSE(fs::exists(folder / "out/tracing")); // images are not kept
    EXPECT_EQ(run_program({"verify", "out"}, folder).exit_code, 0);

    // A second run traces only the stack whose statistics were removed, and writes the same fit.
    std::vector<fs::path> runs;
    for (const auto& entry : fs::directory_iterator(folder / "out/runs")) {
        runs.push_back(entry.path());
    }
    ASSERT_GE(runs.size(), 8u * 4u);
    const auto kept = fs::last_write_time(runs[1]);
    const auto removed = read_file(runs[0]), bytes = read_file(folder / "out/fit.json");
    fs::remove(runs[0]);
    fs::remove(folder / "out/fit.json");
    const auto again = run_program(fit_of("known"), folder);
    ASSERT_EQ(again.exit_code, 0) << again.standard_error;
    EXPECT_EQ(fs::last_write_time(runs[1]), kept);
    EXPECT_EQ(read_file(runs[0]), removed);
    EXPECT_EQ(read_file(folder / "out/fit.json"), bytes);

    // The stack of another number has its own interval; stacks of the model that both need are traced once.
    const auto other = run_program(fit_of("another"), folder);
    ASSERT_EQ(other.exit_code, 0) << other.standard_error;
    const Interval of_another = interval_in(folder / "out/fit.json");
    EXPECT_FALSE(of_another.holds(known)) << of_another.low << " to " << of_another.high;
    EXPECT_TRUE(of_another.holds(another)) << of_another.low << " to " << of_another.high;
}

TEST(Fit, RefusesItsStacksFolderAndOtherPixels) {
    const auto folder = fresh_folder("fit_refusals");
    write_file(folder / "c.toml", small_configuration);
    ASSERT_EQ(run_program({"stack", "c.toml", "--quiet"}, folder).exit_code, 0);
    const std::vector<std::string> command = {"fit", "out", "--free", "specimen.material.g", "--quiet"};
    auto into_stack = command;
    into_stack.insert(into_stack.end(), {"--out", "out"});
    const auto own = run_program(into_stack, folder);
    EXPECT_EQ(own.exit_code, 2);
    EXPECT_THAT(own.standard_error, HasSubstr("a folder other than the stack's"));
    auto other_pixels = command;
    other_pixels.insert(other_pixels.end(), {"--set", "detector.pixels=10"});
    const auto pixels = run_program(other_pixels, folder);
    EXPECT_EQ(pixels.exit_code, 2);
    EXPECT_THAT(pixels.standard_error, HasSubstr("10 x 10, as the configuration makes them"));
    auto other_scan = command;
    other_scan.insert(other_scan.end(), {"--set", "scan.z_stop_um=1"});
    const auto scan = run_program(other_scan, folder);
    EXPECT_EQ(scan.exit_code, 2);
    EXPECT_THAT(scan.standard_error, HasSubstr("more than 4 images"));
}

} // namespace of_fit
} // namespace
} // namespace vkfv::test
