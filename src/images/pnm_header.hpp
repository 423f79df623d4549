// Checks a PNM file (PBM, PGM, PPM, PFM) before the library opens it.
#pragma once

#include <filesystem>
#include <string_view>

namespace vkfv::images {

bool looks_like_pnm(std::string_view bytes);

// Throws InputError if the header is invalid, or if the file is shorter than its pixels need at least. The library
// itself takes missing values for zeros if the header states a largest value of 0.
void check_pnm(std::string_view bytes, const std::filesystem::path& path);

} // namespace vkfv::images
