// Compiled kernels are kept for the next run, and damage to the cache does no harm.
#include "support/own_cache.hpp"
#include "vulkan/kernel.hpp"

#include "spirv/probe_vulkan_arithmetic.h"

namespace vkfv::vulkan {
namespace {

using PipelineCache = test::OwnCache;

// Opens the device, compiles a kernel and closes it; returns the files kept then.
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

TEST_F(PipelineCache, IsNotKeptWhereNothingCanBeWritten) {
    const auto blocked = folder_ / "file";
    std::ofstream(blocked) << "no folder";
    setenv("XDG_CACHE_HOME", blocked.c_str(), 1);
    EXPECT_TRUE(compile().empty());
}

TEST_F(PipelineCache, ADeviceKeepsItsKernelsAndSurvivesADamagedFile) {
    const auto files = compile();
    ASSERT_EQ(files.size(), 1U);
    const auto kept = read_cached(files[0].filename().string());
    EXPECT_GE(kept.size(), 32U); // Vulkan's header at least
    test::overwrite(files[0], static_cast<std::streamoff>(std::filesystem::file_size(files[0]) - 1), '?');
    ASSERT_TRUE(read_cached(files[0].filename().string()).empty());
    EXPECT_EQ(compile(), files);
    EXPECT_FALSE(read_cached(files[0].filename().string()).empty()); // made anew
}

} // namespace vkfv::vulkan
