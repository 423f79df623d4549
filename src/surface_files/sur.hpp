// SUR, the surfaces of Digital Surf's MountainsMap: a header of 512 bytes and integers.
#pragma once

#include "surface_files/surface_file.hpp"

#include <string>
#include <string_view>

namespace vkfv::surface {

bool looks_like_sur(std::string_view bytes);

// Reads a single surface of 16- or 32-bit points, packed by zlib or not, with z in a unit of length. Throws InputError.
SurfaceFile parse_sur(std::string_view bytes, const std::filesystem::path& file);

// Writes 32-bit points in steps of a power of two of mm, so that a file that is read and written again has the same
// points. RunError for heights beyond the range of the format's floats.
std::string sur_bytes(const HeightMap& map, const Provenance& provenance);

} // namespace vkfv::surface
