// A test's own cache folder, and damage to a file in it.
#pragma once

#include "core/files/user_cache.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace vkfv::test {

class OwnCache : public ::testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(folder_);
        setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    }
    void TearDown() override {
        std::filesystem::remove_all(folder_);
        unsetenv("XDG_CACHE_HOME");
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("vkfv_own_cache_" + std::to_string(getpid()));
};

inline void overwrite(const std::filesystem::path& path, std::streamoff place, char value) {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(place);
    file.put(value);
}

} // namespace vkfv::test
