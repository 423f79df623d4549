// What is kept of compiled kernels: given back unharmed, or not at all.
#include "core/user_cache.hpp"
#include "vulkan/kernel.hpp"

#include "spirv/probe_vulkan_arithmetic.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <unistd.h>

namespace vkfv::vulkan {
namespace {

// A cache folder of the test's own.
class PipelineCache : public ::testing::Test {
  protected:
    PipelineCache() {
        std::filesystem::create_directories(folder_);
        setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    }
    ~PipelineCache() override {
        std::filesystem::remove_all(folder_);
        unsetenv("XDG_CACHE_HOME");
    }

    std::filesystem::path folder_ =
        std::filesystem::temp_directory_path() / ("vkfv_pipeline_cache_" + std::to_string(getpid()));
    const std::vector<std::byte> data_ = std::vector<std::byte>(1000, std::byte{42});
};

void overwrite(const std::filesystem::path& path, std::streamoff place, char value) {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(place);
    file.put(value);
}

// Opens the device, compiles a kernel and closes it; the files kept then.
std::vector<std::filesystem::path> compile() {
    {
        const Device device;
        const Kernel kernel(
            device, "probe_vulkan_arithmetic", probe_vulkan_arithmetic,
            {{5, BindingKind::storage_buffer}, {0, BindingKind::uniform_buffer}, {2, BindingKind::storage_buffer}}, 24);
    }
    std::vector<std::filesystem::path> files;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(*cache_folder(), missing)) {
        files.push_back(entry.path());
    }
    return files;
}

} // namespace

TEST_F(PipelineCache, gives_back_what_was_kept) {
    EXPECT_TRUE(read_cached("some").empty());
    write_cached("some", data_);
    EXPECT_EQ(read_cached("some"), data_);
    EXPECT_TRUE(read_cached("other").empty());
    write_cached("some", std::span(data_).first(10));
    EXPECT_EQ(read_cached("some").size(), 10U);
    // Nothing is left aside.
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(*cache_folder()), {}), 1);
}

TEST_F(PipelineCache, damaged_and_foreign_files_are_as_none) {
    const auto path = *cache_folder() / "some";
    const auto size = [&] { return static_cast<std::streamoff>(std::filesystem::file_size(path)); };
    write_cached("some", data_);
    for (const std::streamoff place : {std::streamoff{0}, std::streamoff{20}, size() / 2, size() - 1}) {
        write_cached("some", data_);
        overwrite(path, place, '?');
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

TEST_F(PipelineCache, what_cannot_be_written_is_not) {
    const auto blocked = folder_ / "file";
    std::ofstream(blocked) << "no folder";
    setenv("XDG_CACHE_HOME", blocked.c_str(), 1);
    EXPECT_NO_THROW(write_cached("some", data_));
    EXPECT_TRUE(read_cached("some").empty());
    EXPECT_TRUE(compile().empty());
    setenv("XDG_CACHE_HOME", "relative", 1); // to be ignored
    EXPECT_EQ(cache_folder(), std::filesystem::path(std::getenv("HOME")) / ".cache" / "vkfv");
}

TEST_F(PipelineCache, keeps_those_that_were_written_last) {
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

TEST_F(PipelineCache, a_device_keeps_its_kernels_and_survives_a_damaged_file) {
    const auto files = compile();
    ASSERT_EQ(files.size(), 1U);
    const auto kept = read_cached(files[0].filename().string());
    EXPECT_GE(kept.size(), 32U); // Vulkan's header at least
    overwrite(files[0], static_cast<std::streamoff>(std::filesystem::file_size(files[0]) - 1), '?');
    ASSERT_TRUE(read_cached(files[0].filename().string()).empty());
    EXPECT_EQ(compile(), files);
    EXPECT_FALSE(read_cached(files[0].filename().string()).empty()); // made anew
}

} // namespace vkfv::vulkan
