// SUR, the surfaces of Digital Surf's MountainsMap: a header of 512 bytes and integers.
#pragma once

#include "surface_files/surface_file.hpp"

#include <string>
#include <string_view>

namespace vkfv::surface {

bool looks_like_sur(std::string_view bytes);

// A single surface of 16- or 32-bit points, packed by zlib or not, with z in a unit of length. Throws InputError.
SurfaceFile parse_sur(std::string_view bytes, const std::filesystem::path& file);

// 32-bit points in steps of a power of two of mm, so that what is read back is written the same again. RunError for
// heights beyond what the format's floats can scale.
std::string sur_bytes(const HeightMap& map, const Provenance& provenance);

} // namespace vkfv::surface
