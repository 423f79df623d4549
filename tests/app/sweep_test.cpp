// vkfv sweep traces every combination once, with the noise that its rays make.
#include "app/program.hpp"
#include "images/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string with_sweep(const std::string& sweep) {
    return small_configuration + "\n" + sweep;
}

const std::string of_rays = R"([sweep]
z_um = 0.5

[[sweep.parameter]]
key = "specimen.material.g"
label = "g"
values = [0.3, 1.0]

[[sweep.parameter]]
key = "trace.rays"
label = "N"
values = [2e4, 3.2e5]
)";

// Cells of sweep.csv, the head first.
std::vector<std::vector<std::string>> table(const fs::path& path) {
    std::ifstream stream(path);
    std::vector<std::vector<std::string>> rows;
    for (std::string line; std::getline(stream, line);) {
        rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');)
            rows.back().push_back(cell);
    }
    return rows;
}

TEST(Sweep, ImagesOfEveryCombination) {
    const auto folder = fresh_folder("sweep");
    write_file(folder / "c.toml", with_sweep(of_rays));
    const std::vector<std::string> command = {"--sweep", "c.toml", "--out", "out", "--quiet"};
    const auto first = run_program(command, folder);
    ASSERT_EQ(first.exit_code, 0) << first.standard_error;
    const auto rows = table(folder / "out/sweep.csv");
    ASSERT_EQ(rows.size(), 5u);
    ASSERT_EQ(rows[0][0], "g");
    ASSERT_EQ(rows[0][2], "signal to noise");
    const auto ratio = [&](std::size_t row) { return std::stod(rows[row][2]); };
    // Sixteen times the rays give four times the ratio of signal to noise. With n rays detected its own relative error
    // is 1 / (2 sqrt(n)); five of these for the fewest rays, some 500, are 11 %.
    EXPECT_NEAR(ratio(2) / ratio(1), 4, 0.45);
    EXPECT_NEAR(ratio(4) / ratio(3), 4, 0.45);
    EXPECT_GT(ratio(3), 1.2 * ratio(1)); // a mirror sends more light back into the pupil
    EXPECT_TRUE(fs::exists(folder / "out/sweep.svg"));
    EXPECT_TRUE(fs::exists(folder / "out/charts.svg"));

    // Images that are there are kept, and images that are missing are made again with the same bits.
    const auto kept = fs::last_write_time(folder / "out/g=0.3,N=20000/image.tif");
    const auto image = read_file(folder / "out/g=1,N=320000/image.tif");
    fs::remove_all(folder / "out/g=1,N=320000");
    const auto again = run_program(command, folder);
    ASSERT_EQ(again.exit_code, 0) << again.standard_error;
    EXPECT_EQ(fs::last_write_time(folder / "out/g=0.3,N=20000/image.tif"), kept);
    EXPECT_EQ(read_file(folder / "out/g=1,N=320000/image.tif"), image);

    // Another seed is another image.
    auto other = command;
    other.insert(other.end(), {"--seed", "77"});
    ASSERT_EQ(run_program(other, folder).exit_code, 0);
    EXPECT_NE(read_file(folder / "out/g=1,N=320000/image.tif"), image);
}

// Settings that decide an image or stand beside it make it anew; commas and bars in a label do not break the tables.
TEST(Sweep, AnotherDeviceOrBlurIsAnotherImage) {
    const auto folder = fresh_folder("again");
    write_file(folder / "c.toml", with_sweep(replaced(replaced(of_rays, "label = \"g\"", "label = \"g, \\\"|\\\"\""),
                                                      "[2e4, 3.2e5]", "[2e4]")));
    const std::vector<std::string> command = {"--sweep", "c.toml", "--out", "out", "--quiet"};
    ASSERT_EQ(run_program(command, folder).exit_code, 0);
    EXPECT_THAT(read_file(folder / "out/sweep.csv"), testing::StartsWith("\"g, \"\"|\"\"\",N,"));
    EXPECT_THAT(read_file(folder / "out/sweep.md"), testing::StartsWith("| g, \"\\|\" | N |"));
    const auto digest_with = [&](const std::vector<std::string>& more) {
        auto with = command;
        with.insert(with.end(), more.begin(), more.end());
        EXPECT_EQ(run_program(with, folder).exit_code, 0);
        const auto text = read_file(folder / "out/g, \"|\"=1,N=20000/image.json");
        return text.substr(text.find("digest"), 30);
    };
    const auto first = digest_with({});
    EXPECT_EQ(digest_with({}), first);
    EXPECT_NE(digest_with({"--device", "host"}), first);
    EXPECT_NE(digest_with({"--set", "diffraction.point_spread=airy"}), first);
    EXPECT_TRUE(fs::exists(folder / "out/g, \"|\"=1,N=20000/image_diffracted.tif"));
}

TEST(Sweep, ImagesAtSeveralHeightsAreThoseImages) {
    const auto folder = fresh_folder("heights");
    write_file(
        folder / "c.toml",
        with_sweep("[sweep]\n\n[[sweep.parameter]]\nkey = \"sweep.z_um\"\nlabel = \"z\"\nvalues = [0.0, 1.5]\n"));
    const auto sweep = run_program({"--sweep", "c.toml", "--out", "out", "--quiet", "--rays", "2e4"}, folder);
    ASSERT_EQ(sweep.exit_code, 0) << sweep.standard_error;
    const auto image = run_program({"--image", "c.toml", "--z", "1.5", "--out", "one.tif", "--rays", "2e4"}, folder);
    ASSERT_EQ(image.exit_code, 0) << image.standard_error;
    EXPECT_EQ(images::read_image(folder / "out/z=1.5/image.tif").values, images::read_image(folder / "one.tif").values);
    EXPECT_NE(images::read_image(folder / "out/z=0/image.tif").values, images::read_image(folder / "one.tif").values);
}

// A figure without a value is not drawn, and stays without one when the image is taken over from an earlier run. The
// image without light is warned of, the other is not.
TEST(Sweep, AnImageWithoutLightHasNoNoise) {
    const auto folder = fresh_folder("dark");
    write_file(folder / "c.toml", with_sweep(replaced(of_rays, "[2e4, 3.2e5]", "[1, 2e4]")));
    const std::vector<std::string> command = {"--sweep", "c.toml", "--out", "out", "--quiet", "--device", "host"};
    const auto first = run_program(command, folder);
    ASSERT_EQ(first.exit_code, 0);
    EXPECT_THAT(first.standard_error, HasSubstr("No ray of 1 arrived"));
    EXPECT_THAT(first.standard_error, testing::Not(HasSubstr("No ray of 20000 arrived")));
    const auto rows = table(folder / "out/sweep.csv");
    ASSERT_EQ(rows[0][3], "contrast");
    EXPECT_EQ(rows[1][2] + rows[1][3], "");
    EXPECT_NE(rows[2][2], "");
    const auto charts = read_file(folder / "out/charts.svg");
    ASSERT_EQ(run_program(command, folder).exit_code, 0);
    EXPECT_EQ(read_file(folder / "out/charts.svg"), charts);
}

TEST(Sweep, StacksTellTheNoiseOfHeights) {
    const auto folder = fresh_folder("stacks");
    write_file(folder / "c.toml", with_sweep(R"([sweep]
of = "stacks"
repeats = 2

[[sweep.parameter]]
key = "trace.estimator"
values = ["backward"]
)"));
    const auto result = run_program({"--sweep", "c.toml", "--out", "out", "--quiet", "--rays", "2e4"}, folder);
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    const auto rows = table(folder / "out/sweep.csv");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[1][0], "backward");
    EXPECT_THAT(rows[0], testing::Contains("height noise / um"));
    EXPECT_TRUE(fs::exists(folder / "out/estimator=backward/repeat_001/topography.tif"));
}

TEST(Sweep, WrongCombinationsAreRefusedBeforeTheFirstIsTraced) {
    const auto folder = fresh_folder("wrong");
    write_file(folder / "none.toml", small_configuration);
    const auto none = run_program({"--sweep", "none.toml", "--out", "out"}, folder);
    EXPECT_EQ(none.exit_code, 2);
    EXPECT_THAT(none.standard_error, HasSubstr("[sweep]"));
    write_file(folder / "c.toml", with_sweep(replaced(of_rays, "1.0]", "3.0]")));
    const auto result = run_program({"--sweep", "c.toml", "--out", "out"}, folder);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.standard_error, HasSubstr("specimen.material.g"));
    EXPECT_FALSE(fs::exists(folder / "out/sweep.csv"));
    EXPECT_FALSE(fs::exists(folder / "out/g=0.3,N=20000"));
    for (const char* key : {"sweep.of", "output.directory", "specimen.material.g"}) { // the last a second time
        write_file(folder / "c.toml", with_sweep(replaced(of_rays, "trace.rays", key)));
        const auto refused = run_program({"--sweep", "c.toml", "--out", "out"}, folder);
        EXPECT_EQ(refused.exit_code, 2) << key;
        EXPECT_THAT(refused.standard_error, HasSubstr(key));
    }
    write_file(folder / "c.toml", with_sweep(replaced(of_rays, "z_um", "repeats = 2\nz_um")));
    EXPECT_EQ(run_program({"--sweep", "c.toml", "--out", "out"}, folder).exit_code, 2);
    write_file(folder / "c.toml", with_sweep(replaced(of_rays, "[2e4, 3.2e5]", "2e4")));
    EXPECT_EQ(run_program({"--sweep", "c.toml", "--out", "out"}, folder).exit_code, 2);
}

} // namespace
} // namespace vkfv::test
