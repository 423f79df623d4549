// SDF, the surface data file of ISO 25178-71, binary or as text; metres.
#pragma once

#include "surface_files/surface_file.hpp"

#include <string>
#include <string_view>

namespace vkfv::surface {

bool looks_like_sdf(std::string_view bytes);

// Data types 3, 5, 6 and 7 (float32, int16, int32, float64), not compressed, without checksum. In binary files the
// smallest integer and every float that is not finite are not measured, in texts whatever is no finite number (BAD).
// Throws InputError.
SurfaceFile parse_sdf(std::string_view bytes, const std::filesystem::path& file);

// Both hold at most 65535 points an axis (RunError). The binary file ends with its last point, since Gwyddion knows
// it by its length: there is no room for a position and a comment. In the text NaN is not measured: at the standard's
// BAD Gwyddion gives up.
std::string sdf_bytes(const HeightMap& map, const Provenance& provenance);
std::string sdf_text(const HeightMap& map, const Provenance& provenance);

} // namespace vkfv::surface
