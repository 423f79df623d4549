// The memory of the machine that the program runs on.
#pragma once

#include "core/mathematics/pixel_grid.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace vkfv::measurement {

// The physical memory of this machine, bytes.
inline std::uint64_t memory_of_host() {
    return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

// The largest detector.pixels of the same form that fit into `there` bytes, if `pixels` take `memory` bytes and memory
// is in proportion to their number.
inline std::string pixels_that_fit(ImageSize pixels, std::uint64_t memory, std::uint64_t there) {
    constexpr double margin = 0.9; // share of a side, for memory that does not grow with the pixels
    const double share = margin * std::sqrt(static_cast<double>(there) / static_cast<double>(memory));
    return text_of(ImageSize{.columns = std::max(1, static_cast<int>(share * pixels.columns)),
                             .rows = std::max(1, static_cast<int>(share * pixels.rows))});
}

} // namespace vkfv::measurement
