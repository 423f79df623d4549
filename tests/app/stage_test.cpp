// A stack of a real stage and a camera, through the real program, has the same bytes however it was taken, and is
// another stack where one of their keys is another.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Every error is on at once: random errors hang on the image's number, systematic ones on time or position.
std::string with_stage_and_camera() {
    return replaced(ideal_configuration(), "[output]\n",
                    "[stage]\nscale_error = 0.01\nperiodic_um = 0.05\njitter_um = 0.1\nbacklash_um = 0.3\n"
                    "direction = \"down\"\nvibration_um = [0.1]\nvibration_hz = [203]\nexposure_s = 0.01\nmoments = 3\n"
                    "lateral_drift_um_per_s = [1.0, -0.5]\nrunout_um = 0.5\nlight_noise = 0.05\n"
                    "reading_noise_um = 0.02\nevaluate = \"read\"\n"
                    "[camera]\npreset = \"IMX900\"\n[output]\nimages = \"uint16\"\n");
}

class StageStack : public testing::Test {
  protected:
    StageStack() { write_file(folder_ / "c.toml", with_stage_and_camera()); }

    ProgramResult stack(const std::string& out, const std::vector<std::string>& further = {}) const {
        std::vector<std::string> words = {"stack", "c.toml", "--out", out, "--device", "host"};
        words.insert(words.end(), further.begin(), further.end());
        return run_program(words, folder_);
    }
    // All files except for those in which the folder's name or a time stands.
    std::map<std::string, std::string> files_of(const std::string& out) const {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / out)) {
            const auto name = entry.path().filename().string();
            if (entry.is_regular_file() && !name.starts_with("timings") && name != "report.html" &&
                name != "topography.svg" && name != "checksums.sha256") {
                files[fs::relative(entry.path(), folder_ / out).string()] = read_file(entry.path());
            }
        }
        return files;
    }

    fs::path folder_ = fresh_folder("stage");
};

TEST_F(StageStack, HasTheSameBytesInOneRunResumedAndInShards) {
    ASSERT_EQ(stack("one").exit_code, 0);
    const auto one = files_of("one");
    // The first and the last image that are taken, and one between, are lost.
    fs::copy(folder_ / "one", folder_ / "resumed", fs::copy_options::recursive);
    for (const char* image : {"z_0000.tif", "z_0002.tif", "z_0004.tif"}) {
        ASSERT_TRUE(fs::remove(folder_ / "resumed/images" / image));
    }
    fs::remove(folder_ / "resumed/stage.csv");
    ASSERT_EQ(stack("resumed").exit_code, 0);
    EXPECT_EQ(files_of("resumed"), one);
    // The shards are traced, the later one first.
    for (const char* shard : {"2/2", "1/2"}) {
        ASSERT_EQ(stack("shards", {"--shard", shard}).exit_code, 0);
    }
    ASSERT_EQ(run_program({"merge", "shards"}, folder_).exit_code, 0);
    for (const auto& [file, bytes] : one) {
        if (file != "stack.toml" && file != ".stack.toml") { // these two record a single run
            EXPECT_EQ(read_file(folder_ / "shards" / file), bytes) << file;
        }
    }
    EXPECT_THAT(one.at("stage.csv"), HasSubstr("image,nominal_um,read_um,focal_plane_um"));
    EXPECT_THAT(one.at("results.json"), HasSubstr("\"stage\""));
}

TEST_F(StageStack, KnowsTheStackOfAnotherStageOrCamera) {
    const auto stack = [this](const std::string& out, std::vector<std::string> further = {}) {
        further.insert(further.end(), {"--set", "diffraction.model=none"}); // waves take two thirds of a stack's time
        return StageStack::stack(out, further);
    };
    ASSERT_EQ(stack("out").exit_code, 0);
    const auto images = [&] {
        auto files = files_of("out");
        std::erase_if(files, [](const auto& file) { return !file.first.starts_with("images"); });
        return files;
    };
    const auto taken = images();
    ASSERT_EQ(taken.size(), 5U);
    for (const auto& [key, there, here] : {std::tuple{"stage.jitter_um", "0.1", "0.2"},
                                           {"stage.seed", "1", "2"},
                                           {"camera.read_noise_e", "5.56", "9.0"}}) {
        const auto other = stack("out", {"--set", std::string(key) + "=" + here});
        EXPECT_EQ(other.exit_code, 2) << key;
        EXPECT_THAT(other.standard_error, HasSubstr(std::string(key) + ": " + there + " there, " + here + " here"));
    }
    // The images do not depend on the positions by which heights are told: they stay, the heights do not.
    const auto read = read_file(folder_ / "out/topography.tif");
    ASSERT_EQ(stack("out", {"--set", "stage.evaluate=\"nominal\""}).exit_code, 0);
    EXPECT_EQ(images(), taken);
    EXPECT_NE(read_file(folder_ / "out/topography.tif"), read);
}

// A drift of 1 m/s takes the focal plane 100 mm away from one image to the next, where no light comes from. The wrong
// twin, the same stack on a still stage, has light in all images.
TEST(StageOfAStack, ThatLeavesImagesWithoutLightIsWarnedOf) {
    const auto folder = fresh_folder("dark_images");
    write_file(folder / "c.toml", small_configuration);
    const std::vector<std::string> still = {"stack",  "c.toml", "--device", "host",
                                            "--rays", "2e4",    "--set",    "diffraction.model=none"};
    auto drifting = still;
    drifting.insert(drifting.end(), {"--set", "stage.drift_um_per_s=1e6", "--out", "drifting"});
    EXPECT_THAT(run_program(still, folder).standard_error, testing::Not(HasSubstr("without any light")));
    EXPECT_THAT(run_program(drifting, folder).standard_error, HasSubstr("images are without any light"));
    EXPECT_THAT(read_file(folder / "drifting/results.json"), HasSubstr("dark-images"));
}

} // namespace
} // namespace vkfv::test
