#include "measurement/scene/host_memory.hpp"

#include <unistd.h>

#include <charconv>
#include <fstream>

namespace vkfv::measurement {

namespace fs = std::filesystem;

namespace {

// The number that a file begins with; none for "max" or no file.
std::optional<std::uint64_t> number_in(const fs::path& file) {
    std::string text;
    std::ifstream(file) >> text;
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

} // namespace

std::optional<std::uint64_t> limit_of_groups(const fs::path& groups, const fs::path& mount) {
    std::optional<std::uint64_t> least;
    std::ifstream lines(groups);
    for (std::string line; std::getline(lines, line);) { // "0::/user.slice", of version 1 "4:memory:/job_17/step_0"
        const auto first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) {
            continue;
        }
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const bool has_memory = ("," + controllers + ",").find(",memory,") != std::string::npos;
        if (!controllers.empty() && !has_memory) {
            continue;
        }
        const fs::path root = has_memory ? mount / "memory" : mount;
        const char* const name = has_memory ? "memory.limit_in_bytes" : "memory.max";
        // A container may see its own group as the root, and its path as it is outside.
        fs::path group = fs::path(line.substr(second + 1)).relative_path();
        while (true) {
            if (const auto limit = number_in(root / group / name)) {
                least = std::min(least.value_or(*limit), *limit);
            }
            if (group.empty()) {
                break;
            }
            group = group.parent_path();
        }
    }
    return least;
}

std::uint64_t memory_of_host() {
    const auto of_machine =
        static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    return std::min(of_machine, limit_of_groups().value_or(of_machine));
}

} // namespace vkfv::measurement
