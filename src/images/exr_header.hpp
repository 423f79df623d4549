// Checks an OpenEXR file before the library opens it.
#pragma once

#include <filesystem>
#include <string_view>

namespace vkfv::images {

bool looks_like_exr(std::string_view bytes);

// Throws InputError if an attribute of any of the file's headers is longer than the rest of the file. The library
// allocates an attribute's text before it compares its length with the file: a few hundred bytes may claim 2 GiB.
void check_exr_attributes(std::string_view bytes, const std::filesystem::path& path);

} // namespace vkfv::images
