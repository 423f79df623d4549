// vkfv --verify: what is damaged is found, and the next run makes it again.
#include "app/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace vkfv::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

std::vector<fs::path> files_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file() && entry.path().filename() != ".lock" &&
            !entry.path().filename().string().starts_with("timings")) {
            files.push_back(entry.path());
        }
    }
    return files;
}

// A bit in the middle.
void damage(const fs::path& file) {
    std::string bytes = read_file(file);
    bytes[bytes.size() / 2] ^= 4;
    write_file(file, bytes);
}

// Damages every file, one after the other: found and named; then all, and `command` makes them as they were.
void expect_found_and_healed(const fs::path& folder, const std::string& results,
                             const std::vector<std::string>& command) {
    const auto files = files_in(folder / results);
    ASSERT_GE(files.size(), 5u);
    std::map<fs::path, std::string> whole;
    for (const auto& file : files) {
        whole[file] = read_file(file);
        damage(file);
        const auto found = run_program({"--verify", results}, folder);
        EXPECT_EQ(found.exit_code, 4) << file;
        EXPECT_THAT(found.standard_output,
                    HasSubstr(file.filename() == "checksums.sha256" ? "" : file.filename().string()));
        write_file(file, whole[file]);
    }
    const auto good = run_program({"--verify", results}, folder);
    EXPECT_EQ(good.exit_code, 0) << good.standard_error;
    EXPECT_THAT(good.standard_output, HasSubstr(", 0 damaged"));
    for (const auto& file : files) {
        if (file.filename() != "stack.toml" && file.filename() != "checksums.sha256") {
            damage(file);
        }
    }
    const auto again = run_program(command, folder);
    ASSERT_EQ(again.exit_code, 0) << again.standard_error;
    for (const auto& [file, bytes] : whole) {
        EXPECT_EQ(read_file(file), bytes) << file;
    }
}

TEST(Verify, FindsEveryDamagedFileOfAStack) {
    const auto folder = fresh_folder("stack");
    write_file(folder / "c.toml", small_configuration);
    const std::vector<std::string> command = {"--stack", "c.toml", "--quiet"};
    ASSERT_EQ(run_program(command, folder).exit_code, 0);
    expect_found_and_healed(folder, "out", command);
}

TEST(Verify, FindsEveryDamagedFileOfASweep) {
    const auto folder = fresh_folder("sweep");
    write_file(folder / "c.toml", small_configuration + R"(
[diffraction]
point_spread = "airy"

[sweep]
[[sweep.parameter]]
key = "trace.seed"
values = [1, 2]
)");
    const std::vector<std::string> command = {"--sweep", "c.toml", "--quiet"};
    ASSERT_EQ(run_program(command, folder).exit_code, 0);
    // Without its image a combination is traced again, with a truncated one too.
    write_file(folder / "out/seed=1/image.tif", "II*");
    ASSERT_EQ(run_program(command, folder).exit_code, 0);
    expect_found_and_healed(folder, "out", command);
}

TEST(Verify, AStackThatIsNotFinishedHasItsImagesChecked) {
    const auto folder = fresh_folder("unfinished");
    write_file(folder / "c.toml", small_configuration);
    ASSERT_EQ(run_program({"--stack", "c.toml", "--quiet"}, folder).exit_code, 0);
    fs::remove(folder / "out/checksums.sha256");
    const auto good = run_program({"--verify", "out"}, folder);
    EXPECT_EQ(good.exit_code, 0);
    EXPECT_THAT(good.standard_output, AllOf(HasSubstr("not finished"), HasSubstr("5 files checked")));
    damage(folder / "out/images/z_0002.tif");
    const auto found = run_program({"--verify", "out"}, folder);
    EXPECT_EQ(found.exit_code, 4);
    EXPECT_THAT(found.standard_error, HasSubstr("z_0002.tif"));
}

TEST(Verify, WantsResults) {
    const auto folder = fresh_folder("none");
    EXPECT_EQ(run_program({"--verify", "nowhere"}, folder).exit_code, 2);
    const auto empty = run_program({"--verify", "."}, folder);
    EXPECT_EQ(empty.exit_code, 2);
    EXPECT_THAT(empty.standard_error, HasSubstr("checksums.sha256"));
}

} // namespace
} // namespace vkfv::test
