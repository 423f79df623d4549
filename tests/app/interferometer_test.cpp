// Stacks of an interferometer through the real program: heights, the same bytes however they were made, and refusals.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string example(const std::string& name) {
    return read_file(fs::path(VKFV_SOURCE_DIR) / "assets/stacks" / name);
}

class InterferometerStack : public testing::Test {
  protected:
    InterferometerStack() {
        write_file(folder_ / "c.toml", replaced(example("csi_step.toml"), "pixels = 64", "pixels = 32"));
    }

    ProgramResult stack(const std::string& out, std::vector<std::string> further = {}) const {
        further.insert(further.begin(), {"stack", "c.toml", "--out", out, "--quiet"});
        return run_program(further, folder_);
    }
    std::string file_of(const std::string& out, const std::string& name) const {
        return read_file(folder_ / out / name);
    }

    fs::path folder_ = fresh_folder("interferometer");
};

TEST_F(InterferometerStack, MeasuresAStepBothWays) {
    // The envelope feels the edge farther into the levels.
    for (const auto& [method, tolerance_um] : {std::pair{"phase", 0.005}, {"envelope", 0.03}}) {
        const auto run = stack(method, {"--set", std::string("topography.method=") + method});
        ASSERT_EQ(run.exit_code, 0) << run.standard_error;
        const auto results = nlohmann::json::parse(file_of(method, "results.json"));
        EXPECT_EQ(results.at("topography").at("method"), method);
        EXPECT_EQ(results.at("points").at("measured").get<double>(), 32 * 32);
        EXPECT_NEAR(results.at("dimensions").at(0).at("measured").get<double>(), 0.4, tolerance_um);
    }
}

TEST_F(InterferometerStack, HasTheSameBytesInOneRunResumedAndInShards) {
    ASSERT_EQ(stack("one").exit_code, 0);
    fs::copy(folder_ / "one", folder_ / "resumed", fs::copy_options::recursive);
    for (const char* image : {"z_0000.tif", "z_0057.tif", "z_0114.tif"}) {
        ASSERT_TRUE(fs::remove(folder_ / "resumed/images" / image));
    }
    ASSERT_EQ(stack("resumed").exit_code, 0);
    for (const char* shard : {"2/2", "1/2"}) {
        ASSERT_EQ(stack("shards", {"--shard", shard}).exit_code, 0);
    }
    ASSERT_EQ(run_program({"merge", "shards"}, folder_).exit_code, 0);
    for (const char* out : {"resumed", "shards"}) {
        for (const char* name : {"images/z_0000.tif", "images/z_0057.tif", "images/z_0114.tif", "topography.tif",
                                 "height_uncertainty.tif"}) {
            EXPECT_EQ(file_of(out, name), file_of("one", name)) << out << " " << name;
        }
    }
    // What is written in full reads back to the same stack.
    write_file(folder_ / "c.toml", file_of("one", "stack.toml"));
    const auto again = run_program({"stack", "c.toml", "--out", "one", "--quiet"}, folder_);
    EXPECT_EQ(again.exit_code, 0) << again.standard_error;
}

TEST_F(InterferometerStack, OtherExamplesRun) {
    for (const char* name : {"csi_flat_tilted.toml", "csi_rough.toml"}) {
        write_file(folder_ / "c.toml", replaced(example(name), "pixels = 64", "pixels = 16"));
        const auto run = stack(name);
        ASSERT_EQ(run.exit_code, 0) << run.standard_error;
        const auto results = nlohmann::json::parse(file_of(name, "results.json"));
        EXPECT_EQ(results.at("points").at("measured").get<double>(), 16 * 16) << name;
    }
}

TEST_F(InterferometerStack, IsCheckedBeforeItIsMade) {
    const auto check = run_program({"check", "c.toml"}, folder_);
    EXPECT_EQ(check.exit_code, 0) << check.standard_error;
    EXPECT_THAT(check.standard_output, HasSubstr("An interferometer of 10x/0.3"));
}

TEST_F(InterferometerStack, RefusesByName) {
    struct Refused {
        std::pair<std::string, std::string> change;
        std::vector<std::string> message;
    };
    const std::string text = read_file(folder_ / "c.toml");
    const std::vector<Refused> refused{
        {{"[scan]", "[diffraction]\nmodel = \"waves\"\n[scan]"}, {"diffraction", "nothing beside [reference_arm]"}},
        {{"[scan]", "[trace]\nrays = 1000\n[scan]"}, {"trace.rays", "the fields have no rays"}},
        {{"[scan]", "[cover_glass]\nthickness_mm = 0.17\n[scan]"}, {"cover_glass", "no cover glass"}},
        {{"[scan]", "[interfaces]\nmodel = \"fresnel\"\n[scan]"}, {"interfaces.model", "no reflection losses"}},
        {{"[scan]", "[stage]\nrunout_um = 1\n[scan]"}, {"stage.runout_um", "stands still sideways"}},
        {{"[scan]", "[topography]\nwindow_px = 9\n[scan]"}, {"topography.window_px", "fringes of its own"}},
        {{"[scan]", "[topography]\nmethod = \"focus\"\n[scan]"}, {"topography.method", "\"envelope\" or \"phase\""}},
        {{"z_step_um = 0.07", "z_step_um = 0.2"}, {"scan.z_step_um", "a quarter of the shortest wavelength"}},
        {{"kind = \"michelson\"", "kind = \"michelson\"\nobscuration = 0.2"}, {"reference_arm.obscuration"}},
        {{"kind = \"michelson\"", "kind = \"michelson\"\nglass = \"N-BK8\""}, {"reference_arm.glass", "N-BK8"}},
        {{"scatter = \"mirror\"", "scatter = \"lambertian\""}, {"specimen.material.scatter", "\"mirror\" alone"}},
        {{"kind = \"step\"", "kind = \"rough\"\nsq_um = 2\ncorrelation_length_um = 1\nseed = 1"},
         {"specimen", "on at most 10 %"}}};
    for (const auto& [change, message] : refused) {
        std::string changed = replaced(text, change.first, change.second);
        if (change.second.find("rough") != std::string::npos) {
            changed = replaced(replaced(changed, "height_um = 0.4            # upper level at x > 0\n", ""),
                               "wall_um = 0.05\n", "");
        }
        write_file(folder_ / "c.toml", changed);
        const auto run = run_program({"check", "c.toml"}, folder_);
        EXPECT_EQ(run.exit_code, 2) << change.second << run.standard_output;
        for (const std::string& part : message) {
            EXPECT_THAT(run.standard_error, HasSubstr(part)) << change.second;
        }
    }
    write_file(folder_ / "c.toml", replaced(replaced(text, "[reference_arm]\nkind = \"michelson\"\n", ""), "[scan]",
                                            "[topography]\nmethod = \"phase\"\n[scan]"));
    EXPECT_THAT(run_program({"check", "c.toml"}, folder_).standard_error, HasSubstr("\"focus\" without a"));
}

} // namespace
} // namespace vkfv::test
