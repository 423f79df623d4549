// vkfv verify finds damaged files, and the next run makes them again.
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

// Flips a bit in the middle of the file.
void damage(const fs::path& file) {
    std::string bytes = read_file(file);
    bytes[bytes.size() / 2] ^= 4;
    write_file(file, bytes);
}

// Damages every file, one after the other, which must be found and named; then all, and `command` makes them as they
// were.
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

TEST(Verify, RepairsTheConfigurationOfWholeImagesAlone) {
    const auto folder = fresh_folder("repair");
    write_file(folder / "c.toml", small_configuration);
    ASSERT_EQ(run_program({"--stack", "c.toml", "--quiet"}, folder).exit_code, 0);
    const fs::path out = folder / "out", stack = out / "stack.toml";
    const std::string whole = read_file(stack), image = read_file(out / "images/z_0001.tif"),
                      ledger = read_file(out / "ledger.csv"), copy = read_file(out / ".stack.toml");
    const auto repaired = [&] { return run_program({"verify", "out", "--repair"}, folder); };
    const auto refused = [&](const std::string& why) {
        const auto result = repaired();
        EXPECT_EQ(result.exit_code, 2) << why;
        EXPECT_THAT(result.standard_error, AllOf(HasSubstr(why), HasSubstr("Nothing was written")));
        EXPECT_FALSE(fs::exists(out / "stack.toml.before_repair"));
    };
    EXPECT_EQ(repaired().exit_code, 0); // nothing to do

    const std::string edited = replaced(whole, "seed = 7", "seed = 8");
    write_file(stack, edited);
    const auto found = run_program({"verify", "out"}, folder);
    EXPECT_EQ(found.exit_code, 4);
    EXPECT_THAT(found.standard_error, HasSubstr("vkfv verify out --repair writes stack.toml again"));

    damage(out / "images/z_0001.tif");
    refused("not the file that was written");
    write_file(out / "images/z_0001.tif", image);
    write_file(out / "ledger.csv", replaced(ledger, "\n1,", "\n9,"));
    refused("rows that the images carry");
    write_file(out / "ledger.csv", ledger);
    write_file(out / ".stack.toml", replaced(copy, "#: seed = 7", "#: seed = 8"));
    refused("an identity of another digest than it states");
    write_file(out / ".stack.toml", copy);

    const auto done = repaired();
    EXPECT_EQ(done.exit_code, 0) << done.standard_error;
    EXPECT_EQ(read_file(stack), whole);
    EXPECT_EQ(read_file(out / "stack.toml.before_repair"), edited);
    EXPECT_EQ(run_program({"verify", "out"}, folder).exit_code, 0);

    // A file that was lost as a whole is repaired too, and the results say so.
    fs::remove(stack);
    EXPECT_EQ(run_program({"verify", "out"}, folder).exit_code, 4);
    EXPECT_THAT(run_program({"--stack", "c.toml"}, folder).standard_error, HasSubstr("vkfv verify out --repair"));
    EXPECT_EQ(repaired().exit_code, 0);
    EXPECT_EQ(read_file(stack), whole);
    ASSERT_EQ(run_program({"topography", "out"}, folder).exit_code, 0);
    EXPECT_THAT(read_file(out / "results.json"), HasSubstr("\"repaired\": true"));
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
    // A combination without its image, or with a truncated one, is traced again.
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
