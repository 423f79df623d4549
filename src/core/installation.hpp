// The files that come with the program: where they lie, whether it was installed, moved or only built.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// Beside the program or the module that this code is part of, and beside each folder above it: "lib/vkfv/x.so" of
// /usr/bin/vkfv is /usr/lib/vkfv/x.so. None: no such file or folder. A build has links of the same names.
std::optional<std::filesystem::path> find_installed(const std::filesystem::path& relative);

// Folders of assets (objectives, stacks, ...), the first that has a file counts:
// 1. the one that VKFV_ASSETS names: whoever sets it for a run means it. Throws InputError where it is no folder;
// 2. assets/ beside the folder `base`, and beside each folder above it; none where `base` is empty;
// 3. share/vkfv of the installation, or of the build.
std::vector<std::filesystem::path> asset_folders(const std::filesystem::path& base);

// The third of these, without links. None: the program was copied without it.
std::optional<std::filesystem::path> installed_assets();

// Where the asset `relative` was looked for, for messages: "looked for ... in ..., and in ...".
std::string searched_for_asset(const std::filesystem::path& relative, const std::filesystem::path& base);

// A path as a command was given it. One that begins with assets/ and is not there means the installed file of that
// name, so that an example can be named from any folder.
std::filesystem::path given_or_installed(const std::filesystem::path& path);

// What the linker made of the code that this is part of, in hexadecimal digits: another code has another. Empty if it
// was linked without.
std::string build_id();

} // namespace vkfv
