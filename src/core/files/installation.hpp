// Locates the files that come with the program, whether it was installed, moved or only built.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// A folder and those above it, the nearest first.
std::vector<std::filesystem::path> with_parents(const std::filesystem::path& folder);

// Finds a file or folder beside the program or module that contains this code, or beside a folder above it:
// "lib/vkfv/x.so" of /usr/bin/vkfv is /usr/lib/vkfv/x.so. None if there is none. Builds have links of the same names.
// Throws RunError if a folder without read permission leaves this open.
std::optional<std::filesystem::path> find_installed(const std::filesystem::path& relative);

// The linker's build id of this program or module, in hexadecimal digits, which differs between different code. Empty
// if it was linked without.
std::string build_id();

} // namespace vkfv
