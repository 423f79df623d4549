// Checks of a PNM file (PBM, PGM, PPM, PFM) before the library opens it.
#pragma once

#include <filesystem>
#include <string_view>

namespace vkfv::images {

bool looks_like_pnm(std::string_view bytes);

// The library takes values that are not there for zeros if the largest one is said to be 0. Throws InputError if the
// header is none, or the file is shorter than its pixels take up at least.
void check_pnm(std::string_view bytes, const std::filesystem::path& path);

} // namespace vkfv::images
