// The cache gives entries back to the next run unharmed, or not at all.
#include "support/own_cache.hpp"

#include <cstddef>
#include <iterator>
#include <span>
#include <vector>

namespace vkfv {
namespace {

class UserCache : public test::OwnCache {
  protected:
    const std::vector<std::byte> data_ = std::vector<std::byte>(1000, std::byte{42});
};

TEST_F(UserCache, GivesBackWhatWasKept) {
    EXPECT_TRUE(read_cached("some").empty());
    write_cached("some", data_);
    EXPECT_EQ(read_cached("some"), data_);
    EXPECT_TRUE(read_cached("other").empty());
    write_cached("some", std::span(data_).first(10));
    EXPECT_EQ(read_cached("some").size(), 10U);
    // No temporary file is left beside the entry.
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(*cache_folder()), {}), 1);
}

TEST_F(UserCache, DamagedAndForeignFilesAreAsNone) {
    const auto path = *cache_folder() / "some";
    const auto size = [&] { return static_cast<std::streamoff>(std::filesystem::file_size(path)); };
    write_cached("some", data_);
    for (const std::streamoff place : {std::streamoff{0}, std::streamoff{20}, size() / 2, size() - 1}) {
        write_cached("some", data_);
        test::overwrite(path, place, '?');
        EXPECT_TRUE(read_cached("some").empty()) << place;
    }
    write_cached("some", data_);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
    EXPECT_TRUE(read_cached("some").empty());
    std::filesystem::resize_file(path, 3);
    EXPECT_TRUE(read_cached("some").empty());
    std::ofstream(path) << std::string(5000, 'x');
    EXPECT_TRUE(read_cached("some").empty());
}

TEST_F(UserCache, WhatCannotBeWrittenIsNot) {
    const auto blocked = folder_ / "file";
    std::ofstream(blocked) << "no folder";
    setenv("XDG_CACHE_HOME", blocked.c_str(), 1);
    EXPECT_NO_THROW(write_cached("some", data_));
    EXPECT_TRUE(read_cached("some").empty());
    setenv("XDG_CACHE_HOME", "relative", 1); // to be ignored
    EXPECT_EQ(cache_folder(), std::filesystem::path(std::getenv("HOME")) / ".cache" / "vkfv");
}

TEST_F(UserCache, KeepsThoseThatWereWrittenLast) {
    for (const char* name : {"some-1", "some-2", "some-3", "other"}) {
        write_cached(name, data_);
        usleep(20000); // a tick of the file system's clock
    }
    thin_out_cached("some-", 2);
    EXPECT_TRUE(read_cached("some-1").empty());
    for (const char* name : {"some-2", "some-3", "other"}) {
        EXPECT_EQ(read_cached(name), data_) << name;
    }
}

} // namespace
} // namespace vkfv
