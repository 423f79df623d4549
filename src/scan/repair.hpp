// Restores the stack.toml of a stack with intact images, where it was lost or changed.
#pragma once

#include <filesystem>
#include <string_view>

namespace vkfv::scan {

// A copy of stack.toml, from which repair() restores it.
inline constexpr std::string_view configuration_copy_name = ".stack.toml";
// The replaced file, kept by repair(); results made beside it say that the stack was repaired.
inline constexpr std::string_view before_repair_name = "stack.toml.before_repair";

// Writes stack.toml from its copy, and keeps the replaced file as before_repair_name. Returns false if both are the
// same already. Nothing is written unless the copy's identity has the digest that the copy states, every image is
// intact and has that digest, and every row of ledger.csv is that of its image. Throws InputError for the first of
// these that does not hold, FolderInUse, RunError.
bool repair(const std::filesystem::path& folder);

bool was_repaired(const std::filesystem::path& folder);

} // namespace vkfv::scan
