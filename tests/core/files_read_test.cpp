// The program remembers which files it read, and tells whether they still are as they were.
#include "core/files/file.hpp"
#include "core/files/files_read.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace vkfv {
namespace {

namespace fs = std::filesystem;

class FilesReadTest : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(folder_);
        write("a", "one");
        write("b", "two");
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    fs::path folder_ = fs::temp_directory_path() / ("vkfv_files_read_" + std::to_string(getpid()));
};

TEST_F(FilesReadTest, AreListedOnceFromTheBeginningOn) {
    (void)read_file(folder_ / "a");
    const FilesRead read;
    EXPECT_TRUE(read.stamps().empty());
    (void)read_file(folder_ / "b");
    const FilesRead later;
    (void)read_file(folder_ / "a");
    (void)read_file(folder_ / "b");
    EXPECT_THAT(read.stamps(), ::testing::ElementsAre(::testing::Field(&FileStamp::path, path("b")),
                                                      ::testing::Field(&FileStamp::path, path("a"))));
    EXPECT_THAT(later.stamps(), ::testing::ElementsAre(::testing::Field(&FileStamp::path, path("a")),
                                                       ::testing::Field(&FileStamp::path, path("b"))));
}

TEST_F(FilesReadTest, ChangesShowHoweverTheyAreMade) {
    const auto stamp_of = [&](const std::string& name) {
        const FilesRead read;
        (void)read_file(folder_ / name);
        return read.stamps().at(0);
    };
    const auto changed = [](const FileStamp& before, const auto& change) {
        EXPECT_TRUE(is_unchanged(before));
        usleep(20000); // a tick of the file system's clock
        change();
        return !is_unchanged(before);
    };
    EXPECT_TRUE(changed(stamp_of("a"), [&] { write("a", "longer"); }));
    EXPECT_TRUE(changed(stamp_of("a"), [&] {
        const auto time = fs::last_write_time(folder_ / "a");
        write("a", "equall"); // the same length; the next line sets the time back
        fs::last_write_time(folder_ / "a", time);
    }));
    EXPECT_TRUE(changed(stamp_of("a"), [&] { fs::rename(folder_ / "b", folder_ / "a"); }));
    EXPECT_TRUE(changed(stamp_of("a"), [&] { fs::remove(folder_ / "a"); }));
}

} // namespace
} // namespace vkfv
