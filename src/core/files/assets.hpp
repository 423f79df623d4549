// Assets: the instruments, specimens, glasses and examples that come with the program, and those of the user's own
// folders that stand for them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// Folders of assets (objectives, stacks, ...), the first that has a file counts:
// 1. the one that VKFV_ASSETS names: whoever sets it for a run means it. Throws InputError where it is no folder;
// 2. assets/ beside the folder `base`, and beside each folder above it; none where `base` is empty;
// 3. share/vkfv of the installation, or of the build.
std::vector<std::filesystem::path> asset_folders(const std::filesystem::path& base);

// The file that `name` means: a path ending in .toml, relative to the folder `base`, or the stem of a file
// <folder>/<name>.toml in one of asset_folders(base). None: no such file.
std::optional<std::filesystem::path> find_asset(const std::string& name, const std::filesystem::path& folder,
                                                const std::filesystem::path& base);

// Where find_asset() looks, for messages: "looked for ... in ..., and in ...".
std::string searched_for_asset(const std::string& name, const std::filesystem::path& folder,
                               const std::filesystem::path& base);

// The stems that find_asset() finds in such a folder, 5x before 10x.
std::vector<std::string> asset_names(const std::filesystem::path& folder, const std::filesystem::path& base);

// Whether it is a file of the installed assets, which their names alone mean from anywhere.
bool comes_with_program(const std::filesystem::path& file, const std::filesystem::path& folder);

// A path as a command was given it. One that begins with assets/ and is not there means the installed file of that
// name, so that an example can be named from any folder.
std::filesystem::path given_or_installed(const std::filesystem::path& path);

} // namespace vkfv
