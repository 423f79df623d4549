// GWY, Gwyddion's own files (http://gwyddion.net/documentation/user-guide-en/gwyfile-format.html).
#pragma once

#include "surface_files/surface_file.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace vkfv::surface {

bool looks_like_gwy(std::string_view bytes);

// Reads the first channel whose values are lengths over lengths; points that its mask covers are not measured. XOffset
// and YOffset are the position of the point with the lowest x and y. Throws InputError.
SurfaceFile parse_gwy(std::string_view bytes, const std::filesystem::path& file);

// An image of a file, with its title and unit.
struct GwyChannel {
    std::string title;
    std::string unit = "m"; // "m": the map's mm are converted to it; values of other units are written unchanged
    HeightMap map;
};

// Writes float64, with a mask if points are not measured.
std::string gwy_bytes(const std::vector<GwyChannel>& channels, const Provenance& provenance);
std::string gwy_bytes(const HeightMap& map, const Provenance& provenance);

} // namespace vkfv::surface
