// Later programs open, verify, evaluate and resume the stack folders that 1.0.0 made, or refuse them by name.
// tests/data/stacks_1.0.0 has stack.toml, which both folders were traced from on the host, so that no device of a
// machine is part of what they are; finished, without its report.html of 1.4 MB; and begun, which SIGINT ended.
#include "app/program.hpp"
#include "support/surface_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr int images = 11, images_of_begun = 3;
// Another compiler and mathematical library may round otherwise than those of 1.0.0; heights of these stacks have a
// standard uncertainty of 0.18 um.
constexpr double same_height = 1e-6; // mm

// Copies stack.toml and both folders to where they may be changed.
fs::path copied_stacks() {
    auto folder = fresh_folder("stacks");
    fs::copy(fs::path(VKFV_SOURCE_DIR) / "tests/data/stacks_1.0.0", folder,
             fs::copy_options::recursive | fs::copy_options::overwrite_existing);
    return folder;
}

std::string image_name(int image) {
    return "images/z_00" + std::to_string(image / 10) + std::to_string(image % 10) + ".tif";
}

void expect_same_heights(const fs::path& here, const fs::path& there) {
    const auto a = surface::read_height_map(here), b = surface::read_height_map(there);
    ASSERT_EQ(a.height.values.size(), b.height.values.size());
    int measured = 0;
    for (std::size_t k = 0; k < a.height.values.size(); ++k) {
        const double one = a.height.values[k], other = b.height.values[k];
        ASSERT_EQ(std::isfinite(one), std::isfinite(other)) << k;
        if (std::isfinite(one)) {
            EXPECT_NEAR(one, other, same_height) << k;
            ++measured;
        }
    }
    EXPECT_GT(measured, 900) << "of 1024 points";
}

} // namespace

TEST(OldStacks, AFinishedOneIsVerified) {
    const auto folder = copied_stacks();
    const auto found = run_program({"verify", "finished"}, folder);
    EXPECT_EQ(found.exit_code, 4); // its report is left out of the repository
    EXPECT_THAT(found.standard_output, AllOf(HasSubstr("report.html"), HasSubstr("29 files checked"),
                                             HasSubstr(", 1 damaged"), Not(HasSubstr(".tif"))));
}

TEST(OldStacks, ADamagedImageOfAFinishedOneIsTold) {
    const auto folder = copied_stacks();
    const auto path = folder / "finished" / image_name(5);
    std::string bytes = read_file(path);
    bytes[bytes.size() / 2] ^= 4;
    write_file(path, bytes);
    const auto found = run_program({"verify", "finished"}, folder);
    EXPECT_EQ(found.exit_code, 4);
    EXPECT_THAT(found.standard_output, AllOf(HasSubstr(image_name(5)), HasSubstr(", 2 damaged")));
}

TEST(OldStacks, AFinishedOneIsEvaluatedToTheHeightsThatItHolds) {
    const auto folder = copied_stacks();
    const auto again = run_program({"topography", "finished", "--out", "again", "--quiet"}, folder);
    ASSERT_EQ(again.exit_code, 0) << again.standard_error;
    expect_same_heights(folder / "again/topography.tif", folder / "finished/topography.tif");
    expect_same_heights(folder / "again/truth.tif", folder / "finished/truth.tif");
}

TEST(OldStacks, OneThatWasBegunHasItsImagesVerified) {
    const auto folder = copied_stacks();
    const auto good = run_program({"verify", "begun"}, folder);
    EXPECT_EQ(good.exit_code, 0) << good.standard_error;
    EXPECT_THAT(good.standard_output,
                AllOf(HasSubstr("not finished"), HasSubstr("3 files checked in begun, 0 damaged")));
    std::string bytes = read_file(folder / "begun" / image_name(1));
    bytes[bytes.size() / 2] ^= 4;
    write_file(folder / "begun" / image_name(1), bytes);
    const auto found = run_program({"verify", "begun"}, folder);
    EXPECT_EQ(found.exit_code, 4);
    EXPECT_THAT(found.standard_error, HasSubstr("z_0001.tif"));
}

// A program with the kernels of 1.0.0 goes on with what was begun. Any other must not mix its images with those: it
// names what differs, and leaves the folder as it is.
TEST(OldStacks, OneThatWasBegunIsResumedOrRefusedByName) {
    const auto folder = copied_stacks();
    std::vector<std::string> before;
    for (int image = 0; image < images_of_begun; ++image) {
        before.push_back(read_file(folder / "begun" / image_name(image)));
    }
    const std::string stack = read_file(folder / "begun/stack.toml");
    const auto resumed = run_program({"stack", "stack.toml", "--out", "begun"}, folder);
    for (int image = 0; image < images_of_begun; ++image) {
        EXPECT_EQ(read_file(folder / "begun" / image_name(image)), before[static_cast<std::size_t>(image)]) << image;
    }
    if (resumed.exit_code == 0) {
        EXPECT_THAT(resumed.standard_error, HasSubstr("8 images traced, 3 kept"));
        EXPECT_TRUE(fs::exists(folder / "begun" / image_name(images - 1)));
        expect_same_heights(folder / "begun/topography.tif", folder / "finished/topography.tif");
        return;
    }
    EXPECT_EQ(resumed.exit_code, 2);
    EXPECT_THAT(resumed.standard_error,
                AllOf(HasSubstr("begun/stack.toml"), HasSubstr("a stack of another configuration"),
                      HasSubstr("Give another --out, or remove the folder. What differs:"),
                      HasSubstr("made.kernels_digest: \"edc6e88fd20d30d2\" there, ")));
    EXPECT_THAT(resumed.standard_error, Not(HasSubstr("trace."))) << "a key of the configuration differs";
    EXPECT_EQ(read_file(folder / "begun/stack.toml"), stack);
    EXPECT_FALSE(fs::exists(folder / "begun" / image_name(images_of_begun)));
}

} // namespace vkfv::test
