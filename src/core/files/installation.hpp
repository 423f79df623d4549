// Where the files lie that come with the program, whether it was installed, moved or only built.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// The folder and those above it, the nearest first.
std::vector<std::filesystem::path> with_parents(const std::filesystem::path& folder);

// Beside the program or the module that this code is part of, and beside each folder above it: "lib/vkfv/x.so" of
// /usr/bin/vkfv is /usr/lib/vkfv/x.so. None: no such file or folder. A build has links of the same names.
// Throws RunError where it cannot be told because a folder may not be looked into.
std::optional<std::filesystem::path> find_installed(const std::filesystem::path& relative);

// What the linker made of the code that this is part of, in hexadecimal digits: another code has another. Empty if it
// was linked without.
std::string build_id();

} // namespace vkfv
