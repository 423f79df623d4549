// The memory that a process may have where a container or a batch system limits it.
#include "measurement/scene/host_memory.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace vkfv::measurement {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

TEST(HostMemory, IsLimitedByTheGroupsAroundAProcess) {
    const fs::path folder = fs::temp_directory_path() / ("vkfv-groups-" + std::to_string(getpid()));
    fs::remove_all(folder);
    const fs::path groups = folder / "cgroup", mount = folder / "mount";
    EXPECT_EQ(limit_of_groups(groups, mount), std::nullopt);
    write(groups, "0::/slurm/job_17/step_0\n");
    write(mount / "slurm/job_17/step_0/memory.max", "max\n");
    EXPECT_EQ(limit_of_groups(groups, mount), std::nullopt);
    write(mount / "slurm/job_17/memory.max", "8589934592\n");
    write(mount / "slurm/memory.max", "17179869184\n");
    EXPECT_EQ(limit_of_groups(groups, mount), 8589934592u);
    // Version 1, in a container that sees its own group as the root.
    write(groups, "5:cpuset:/\n4:cpu,memory:/docker/1f\n1:name=systemd:/\n");
    write(mount / "memory/memory.limit_in_bytes", "4294967296\n");
    EXPECT_EQ(limit_of_groups(groups, mount), 4294967296u);
    fs::remove_all(folder);
}

TEST(HostMemory, IsNoMoreThanTheMachines) {
    const auto machine =
        static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    EXPECT_GT(memory_of_host(), 0u);
    EXPECT_LE(memory_of_host(), machine); // a group of version 1 without a limit has nearly 2^63
}

} // namespace
} // namespace vkfv::measurement
