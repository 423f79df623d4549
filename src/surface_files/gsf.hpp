// GSF, Gwyddion Simple Field: lines of text and float32 (http://gwyddion.net/documentation/user-guide-en/gsf.html).
#pragma once

#include "surface_files/surface_file.hpp"

#include <string>
#include <string_view>

namespace vkfv::surface {

bool looks_like_gsf(std::string_view bytes);

// Reads heights in a unit of length over a grid in a unit of length; NaN is not measured. XOffset and YOffset are the
// position of the point with the lowest x and y. Throws InputError.
SurfaceFile parse_gsf(std::string_view bytes, const std::filesystem::path& file);

// Writes float32 metres. RunError for a map without extent.
std::string gsf_bytes(const HeightMap& map, const Provenance& provenance);

} // namespace vkfv::surface
