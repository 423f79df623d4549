// The bytes of a file.
#pragma once

#include <filesystem>
#include <string>

namespace vkfv::surface {

// Throws InputError if there is no file that can be read.
std::string whole_file(const std::filesystem::path& path);

} // namespace vkfv::surface
