// The memory of the machine that the program runs on.
#pragma once

#include "core/mathematics/pixel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace vkfv::measurement {

// The limit (bytes) that control groups set to the memory of a process: of its own group and of all groups around it,
// by version 1 or 2. Containers and batch systems set it. groups: the file that lists the groups of the process; mount:
// the folder that has the groups; none if nothing limits it.
std::optional<std::uint64_t> limit_of_groups(const std::filesystem::path& groups = "/proc/self/cgroup",
                                             const std::filesystem::path& mount = "/sys/fs/cgroup");

// The memory that this process may have, bytes: the machine's, or less where its control groups say so.
std::uint64_t memory_of_host();

// The largest detector.pixels of the same form that fit into `there` bytes, if `pixels` take `memory` bytes and memory
// is in proportion to their number.
inline std::string pixels_that_fit(ImageSize pixels, std::uint64_t memory, std::uint64_t there) {
    constexpr double margin = 0.9; // share of a side, for memory that does not grow with the pixels
    const double share = margin * std::sqrt(static_cast<double>(there) / static_cast<double>(memory));
    return text_of(ImageSize{.columns = std::max(1, static_cast<int>(share * pixels.columns)),
                             .rows = std::max(1, static_cast<int>(share * pixels.rows))});
}

} // namespace vkfv::measurement
