// The stack.toml of a stack whose images are whole, written again where it was lost or changed.
#pragma once

#include <filesystem>
#include <string_view>

namespace vkfv::scan {

// A copy of stack.toml, which repair() takes the text from.
inline constexpr std::string_view configuration_copy_name = ".stack.toml";
// The file that repair() found in its place; results made where it lies say that the stack was repaired.
inline constexpr std::string_view before_repair_name = "stack.toml.before_repair";

// Writes stack.toml from its copy, and keeps what was there beside it under before_repair_name. False where it is what
// the copy says already. Nothing is written unless the copy's identity has the digest that the copy states, every image
// is whole and carries that digest, and every row of ledger.csv is that of its image. Throws InputError for the first
// of these that does not hold, FolderInUse, RunError.
bool repair(const std::filesystem::path& folder);

bool was_repaired(const std::filesystem::path& folder);

} // namespace vkfv::scan
