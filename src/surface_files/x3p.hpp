// X3P, the exchange format of ISO 5436-2 and ISO 25178-72: a ZIP of main.xml (metres), raw heights and checksums.
#pragma once

#include "surface_files/surface_file.hpp"

#include <string>
#include <string_view>

namespace vkfv::surface {

bool looks_like_x3p(std::string_view bytes);

// Reads a surface on a regular grid: FeatureType SUR, CX and CY incremental, no rotation, heights as I, L, F or D in a
// binary file, or as text in main.xml itself; all at the archive's root or in one folder of it. Points that valid.bin
// excludes and heights that are not finite are not measured. A wrong MD5 sum is an error, or a warning if checksums may
// be stale; a missing one is a warning in the log. Throws InputError.
SurfaceFile parse_x3p(std::string_view bytes, const std::filesystem::path& file,
                      Checksums checksums = Checksums::must_hold);

// Writes heights as D; not-measured points are NaN and excluded by valid.bin. The file conforms to the published schema
// of 2008.
std::string x3p_bytes(const HeightMap& map, const Provenance& provenance);

} // namespace vkfv::surface
