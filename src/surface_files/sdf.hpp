// SDF, the surface data file of ISO 25178-71, binary or as text; metres.
#pragma once

#include "surface_files/surface_file.hpp"

#include <string>
#include <string_view>

namespace vkfv::surface {

bool looks_like_sdf(std::string_view bytes);

// Reads data types 0 to 7 (uint8, uint16, uint32, float32, int8, int16, int32, float64), not compressed, without
// checksum. Not measured are, in binary files, the lowest value of signed and the largest of unsigned integers of
// several bytes and floats that are not finite; in texts, words that are no finite number (BAD). Throws InputError.
SurfaceFile parse_sdf(std::string_view bytes, const std::filesystem::path& file);

// Write SDF, binary or as text, of at most 65535 points an axis (RunError). The binary file ends with its last point,
// since Gwyddion recognizes it by its length: it has no room for position and comment. In the text NaN marks points
// that are not measured: Gwyddion fails at the standard's BAD.
std::string sdf_bytes(const HeightMap& map, const Provenance& provenance);
std::string sdf_text(const HeightMap& map, const Provenance& provenance);

} // namespace vkfv::surface
