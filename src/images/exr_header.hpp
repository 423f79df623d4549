// Checks of an OpenEXR file before the library opens it.
#pragma once

#include <filesystem>
#include <string_view>

namespace vkfv::images {

bool looks_like_exr(std::string_view bytes);

// The library makes room for an attribute's text before it looks whether the file is long enough: a few hundred bytes
// may ask for 2 GiB. Throws InputError if an attribute of any of the file's headers is longer than what is left of it.
void check_exr_attributes(std::string_view bytes, const std::filesystem::path& path);

} // namespace vkfv::images
