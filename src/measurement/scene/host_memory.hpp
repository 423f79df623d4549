// The memory of the machine that the program runs on.
#pragma once

#include <unistd.h>

#include <cstdint>

namespace vkfv::measurement {

// Physical memory, bytes.
inline std::uint64_t memory_of_host() {
    return static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

} // namespace vkfv::measurement
