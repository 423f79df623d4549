// vkfv budget measures what uncertain numbers do to a result, goes on where it ended, and writes a budget.
#include "app/program.hpp"
#include "core/files/file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

using Words = std::vector<std::string>;

// Writes the shipped example with these uncertainties in place of its own, and returns the command for a small form of
// it.
Words budget_of(const std::string& measurand, const std::string& uncertainties, const fs::path& folder) {
    const auto text = read_file(VKFV_SOURCE_DIR "/assets/stacks/groove_budget.toml");
    write_file(folder / "c.toml", text.substr(0, text.find("[uncertainty]")) + "[uncertainty]\n" + uncertainties);
    return {"budget",      "c.toml",
            "--measurand", measurand,
            "--repeats",   "2",
            "--out",       "out",
            "--rays",      "131072",
            "--set",       "detector.pixels=[128,16]",
            "--set",       "scan.z_step_um=1",
            "--quiet"};
}

const json& row(const json& budget, const std::string& key) {
    for (const json& input : budget.at("inputs")) {
        if (input.at("key") == key) {
            return input;
        }
    }
    throw std::runtime_error("no row of " + key);
}

double contribution(const json& budget, const std::string& key) {
    return row(budget, key).at("contribution");
}

// Contributions in closed form: pixels that are taken for larger than they are stretch a width, and so do lenses of
// another focal length, since the instrument goes on believing in its pitch.
TEST(UncertaintyBudget, HasContributionsInClosedForm) {
    const auto folder = fresh_folder("budget_closed_form");
    auto command = budget_of("width",
                             "\"detector.assumed_pitch_um\" = {u = 0.005}\n"
                             "\"tube_lens.focal_length_mm\" = {u = 6, pdf = \"rectangular\"}\n",
                             folder);
    command.emplace_back("--json");
    const auto result = run_program(command, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const auto width = json::parse(result.standard_output);
    EXPECT_EQ(width.at("measurand").at("name"), "width at half depth");
    EXPECT_NEAR(width.at("truth").get<double>(), 14, 0.01);
    const double measured = width.at("measured");
    EXPECT_NEAR(measured, 14, 1);
    EXPECT_NEAR(contribution(width, "detector.assumed_pitch_um"), measured * 0.005 / 0.345, 0.01);
    // Larger images see the print by other pixels, so the tolerance is that of another texture.
    EXPECT_NEAR(contribution(width, "tube_lens.focal_length_mm"), measured * 6 / 200, 0.1);
    EXPECT_EQ(row(width, "tube_lens.focal_length_mm").at("distribution"), "rectangular");
    EXPECT_EQ(width.at("by_trials"), nullptr);
    EXPECT_TRUE(width.at("texture").is_object());
}

TEST(UncertaintyBudget, GoesOnWhereItEndedAndRefusesOtherInputs) {
    const auto folder = fresh_folder("budget");
    auto command = budget_of("groove depth",
                             "\"stage.scale_error\" = {u = 0.02, source = \"certificate of the scale\"}\n", folder);
    command.insert(command.end(), {"--trials", "2"});
    const auto first = run_program(command, folder);
    ASSERT_EQ(first.exit_code, 0) << first.standard_error;
    EXPECT_THAT(first.standard_output, HasSubstr("combined standard uncertainty"));
    EXPECT_THAT(first.standard_output, HasSubstr("2 trials"));
    EXPECT_THAT(first.standard_output, HasSubstr("not traceable"));
    const auto budget = json::parse(read_file(folder / "out/budget.json"));
    EXPECT_NEAR(contribution(budget, "stage.scale_error"), 4 * 0.02, 0.01);
    EXPECT_EQ(budget.at("by_trials").at("errors").size(), 2u);
    const auto page = read_file(folder / "out/budget.html");
    EXPECT_THAT(page, HasSubstr("certificate of the scale"));
    EXPECT_THAT(page, HasSubstr("not traceable"));

    // A second run measures only the trial whose folder was removed, and writes the same budget.
    const auto image = [&](const std::string& run) { return folder / "out" / run / "images/z_0002.tif"; };
    EXPECT_NE(read_file(image("trials/00000")), read_file(image("trials/00001")));
    const auto kept = fs::last_write_time(image("trials/00000"));
    fs::remove_all(folder / "out/trials/00001");
    fs::remove(folder / "out/budget.json");
    const auto again = run_program(command, folder);
    ASSERT_EQ(again.exit_code, 0) << again.standard_error;
    EXPECT_EQ(fs::last_write_time(image("trials/00000")), kept);
    EXPECT_EQ(json::parse(read_file(folder / "out/budget.json")), budget);
    EXPECT_EQ(run_program({"verify", "out"}, folder).exit_code, 0);
    EXPECT_EQ(run_program({"verify", "out/trials/00001"}, folder).exit_code, 0);

    // Trials that were begun with other uncertainties are not mixed with these.
    auto other = command;
    other.insert(other.end(), {"--set", "uncertainty.stage.scale_error.u=0.03"});
    const auto refused = run_program(other, folder);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.standard_error, HasSubstr("stage.scale_error"));
}

TEST(UncertaintyBudget, SaysWhichQuantitiesTheStackHas) {
    const auto folder = fresh_folder("budget_of_nothing");
    const auto command = budget_of("diameter", "\"scan.z_step_um\" = {u = 1e-3}\n", folder);
    const auto result = run_program(command, folder);
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_THAT(result.standard_error, HasSubstr("no diameter"));
    EXPECT_THAT(result.standard_error, HasSubstr("\"groove depth\""));
}

} // namespace
} // namespace vkfv::test
