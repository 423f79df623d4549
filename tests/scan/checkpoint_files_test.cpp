#include "scan/checkpoint_files.hpp"

#include "core/files/file.hpp"
#include "scan/fake_stack.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace vkfv::scan::test {
namespace {

class HalfDone : public testing::Test {
  protected:
    HalfDone() { make_folder(folder_.path()); }

    CheckpointFiles files(const std::string& digest = "0123456789abcdef") const {
        return {[this](std::uint32_t image) { return folder_.path() / ("partial_" + std::to_string(image)); }, digest,
                60};
    }

    FreshFolder folder_{"checkpoints"};
    trace::Checkpoint checkpoint_{.done = 12345678901, .numbers = {1, 2, std::uint64_t{1} << 63}};
};

TEST_F(HalfDone, ComeBackAsTheyWereKept) {
    EXPECT_FALSE(files().load(7));
    files().save(7, checkpoint_);
    const auto found = files().load(7);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->done, checkpoint_.done);
    EXPECT_EQ(found->numbers, checkpoint_.numbers);
    EXPECT_FALSE(files().load(8));
    files().drop(7);
    EXPECT_FALSE(files().load(7));
    files().drop(7); // there is no file to drop
}

TEST_F(HalfDone, OfAnotherExposureAreNotTakenUp) {
    files().save(7, checkpoint_);
    EXPECT_FALSE(files("fedcba9876543210").load(7));
    std::filesystem::rename(folder_.path() / "partial_7", folder_.path() / "partial_8");
    EXPECT_FALSE(files().load(8));
}

TEST_F(HalfDone, AnyBitThatFlipsIsSeen) {
    files().save(7, checkpoint_);
    const auto path = folder_.path() / "partial_7";
    const std::string whole = read_file(path);
    for (std::size_t place = 0; place < whole.size(); ++place) {
        std::string damaged = whole;
        damaged[place] = static_cast<char>(damaged[place] ^ 1);
        write_file(path, damaged);
        EXPECT_FALSE(files().load(7)) << place;
    }
    for (const std::size_t bytes : {whole.size() - 1, whole.size() - 8, std::size_t{40}, std::size_t{0}}) {
        write_file(path, whole.substr(0, bytes));
        EXPECT_FALSE(files().load(7)) << bytes;
    }
    write_file(path, whole);
    EXPECT_TRUE(files().load(7));
}

TEST_F(HalfDone, ADiskThatRefusesThemEndsNothing) {
    const CheckpointFiles nowhere([](std::uint32_t) { return std::filesystem::path("/proc/vkfv/partial_0"); },
                                  "0123456789abcdef", 60);
    EXPECT_NO_THROW(nowhere.save(0, checkpoint_));
    std::filesystem::remove_all(folder_.path());
    EXPECT_NO_THROW(files().save(7, checkpoint_));
    EXPECT_FALSE(std::filesystem::exists(folder_.path())); // a new folder would lack all other files
}

} // namespace
} // namespace vkfv::scan::test
