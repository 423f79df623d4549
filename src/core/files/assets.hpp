// Assets: the instruments, specimens, glasses and examples that come with the program, and the user's own folders that
// override them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vkfv {

// Folders of assets (objectives, stacks, ...) in the order of their search:
// 1. the folder in VKFV_ASSETS, which a user sets for a run on purpose. Throws InputError if it is no folder;
// 2. assets/ beside the folder `base`, and beside each folder above it; none if `base` is empty;
// 3. share/vkfv of the installation, or of the build.
std::vector<std::filesystem::path> asset_folders(const std::filesystem::path& base);

// The file of a name: a path ending in .toml, relative to the folder `base`, or the stem of a file <folder>/<name>.toml
// in one of asset_folders(base). None if there is no such file.
std::optional<std::filesystem::path> find_asset(const std::string& name, const std::filesystem::path& folder,
                                                const std::filesystem::path& base);

// The places that find_asset() searches, for messages: "looked for ... in ..., and in ...".
std::string searched_for_asset(const std::string& name, const std::filesystem::path& folder,
                               const std::filesystem::path& base);

// The stems that find_asset() finds in such a folder, in natural order: 5x before 10x.
std::vector<std::string> asset_names(const std::filesystem::path& folder, const std::filesystem::path& base);

// True for a file of the installed assets, which their names alone identify from anywhere.
bool comes_with_program(const std::filesystem::path& file, const std::filesystem::path& folder);

// A path given to a command. One that begins with assets/ and does not exist stands for the installed file of that
// name, so that an example can be named from any folder.
std::filesystem::path given_or_installed(const std::filesystem::path& path);

} // namespace vkfv
