// A folder of results belongs to one program at a time, and its list of checksums shows damage.
#include "core/files/file.hpp"
#include "core/files/result_folder.hpp"
#include "core/messages/error.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;
using vkfv::ResultFolder;

class ResultFolderTest : public testing::Test {
  protected:
    ResultFolderTest() { fs::remove_all(folder); }
    ~ResultFolderTest() override { fs::remove_all(folder); }

    std::vector<std::string> damaged() const {
        std::vector<std::string> names;
        for (const auto& damage : vkfv::check_by_checksums(folder).damages) {
            names.push_back(damage.file.string());
        }
        return names;
    }

    fs::path folder =
        fs::temp_directory_path() /
        fmt::format("vkfv_results_{}_{}", testing::UnitTest::GetInstance()->current_test_info()->name(), getpid());
};

TEST_F(ResultFolderTest, OneProgramAtATime) {
    {
        const ResultFolder holder(folder / "a" / "b");
        EXPECT_THROW(ResultFolder(folder / "a" / "b"), vkfv::FolderInUse);
        EXPECT_NO_THROW(ResultFolder(folder / "a"));
    }
    EXPECT_NO_THROW(ResultFolder(folder / "a" / "b"));
}

TEST_F(ResultFolderTest, TheListFindsEveryFlippedByte) {
    {
        ResultFolder results(folder);
        results.write("one.txt", "first");
        results.write("sub/two.txt", "second");
        results.write_checksums();
    }
    EXPECT_THAT(damaged(), IsEmpty());
    EXPECT_EQ(
        std::system(fmt::format("cd '{}' && sha256sum --quiet --strict -c checksums.sha256", folder.string()).c_str()),
        0);
    for (const char* name : {"one.txt", "sub/two.txt", "checksums.sha256"}) {
        const std::string whole = vkfv::read_file(folder / name);
        for (std::size_t place = 0; place < whole.size(); ++place) {
            std::string flipped = whole;
            flipped[place] ^= 1;
            std::ofstream(folder / name, std::ios::binary) << flipped;
            EXPECT_THAT(damaged(), testing::Not(IsEmpty())) << name << " at " << place;
        }
        std::ofstream(folder / name, std::ios::binary) << whole;
    }
    EXPECT_THAT(damaged(), IsEmpty());
    fs::remove(folder / "one.txt");
    EXPECT_THAT(damaged(), ElementsAre("one.txt"));
}

TEST_F(ResultFolderTest, LaterRunsKeepWhatTheyDoNotWrite) {
    {
        ResultFolder results(folder);
        results.write("kept.txt", "kept");
        results.write("changed.txt", "before");
        results.write("removed.txt", "x");
        results.write_checksums();
    }
    fs::remove(folder / "removed.txt");
    {
        ResultFolder results(folder);
        EXPECT_TRUE(results.holds("kept.txt"));
        EXPECT_FALSE(results.holds("removed.txt"));
        EXPECT_FALSE(results.holds("never.txt"));
        results.write("changed.txt", "after");
        results.write_checksums();
    }
    const auto check = vkfv::check_by_checksums(folder);
    EXPECT_THAT(check.files, ElementsAre("changed.txt", "kept.txt"));
    EXPECT_THAT(check.damages, IsEmpty());
    std::ofstream(folder / "kept.txt") << "kepT";
    EXPECT_FALSE(ResultFolder(folder).holds("kept.txt"));
}

// In a folder made anew the files written before would be missing, and nobody would know.
TEST_F(ResultFolderTest, IsNotMadeAnewOnceItIsRemoved) {
    ResultFolder results(folder);
    results.write("one.txt", "x");
    fs::remove_all(folder);
    EXPECT_THROW(results.write("sub/two.txt", "x"), vkfv::FolderRemoved);
    EXPECT_THROW(results.write_in_parts("three.txt", [](const vkfv::AddBytes& add) { add("x"); }), vkfv::FolderRemoved);
    EXPECT_THROW(results.write_checksums(), vkfv::FolderRemoved);
    EXPECT_FALSE(fs::exists(folder));
    const ResultFolder another(folder); // in its place
    EXPECT_THROW(results.write("two.txt", "x"), vkfv::FolderRemoved);
    EXPECT_FALSE(fs::exists(folder / "two.txt"));
}

TEST_F(ResultFolderTest, FoldersInItAreNotMadeAnewEither) {
    ResultFolder results(folder);
    results.write("sub/one.txt", "x");
    fs::remove_all(folder / "sub");
    EXPECT_THROW(results.write("sub/two.txt", "x"), vkfv::FolderRemoved);
    EXPECT_FALSE(fs::exists(folder / "sub"));
    EXPECT_NO_THROW(results.write("other/two.txt", "x"));
    fs::remove(folder / ".lock"); // nothing that was written
    EXPECT_NO_THROW(results.write("other/three.txt", "x"));
    const fs::path elsewhere = folder.string() + "_renamed";
    fs::rename(folder, elsewhere);
    EXPECT_THROW(results.write("other/four.txt", "x"), vkfv::FolderRemoved);
    fs::rename(elsewhere, folder);
    EXPECT_NO_THROW(results.write("other/four.txt", "x"));
}

// A list that another program wrote does not lead out of the folder.
TEST_F(ResultFolderTest, NamesOutsideAreNotFollowed) {
    vkfv::make_folder(folder);
    const std::string sum(64, '0');
    std::ofstream(folder / "checksums.sha256") << sum << "  ../secret\n" << sum << "  /etc/passwd\n";
    const auto check = vkfv::check_by_checksums(folder);
    EXPECT_THAT(check.files, IsEmpty());
    EXPECT_EQ(check.damages.size(), 2u);
}

} // namespace
