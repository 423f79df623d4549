// Heights as text: a matrix of numbers (csv, txt, asc), or x, y and z of the points of a regular grid (xyz).
#pragma once

#include "surface_files/surface_file.hpp"

#include <string>
#include <string_view>

namespace vkfv::surface {

// No content of its own tells such a file: by its name's ending, .csv .txt .asc .xyz in lower case.
bool named_like_height_table(std::string_view name);

// Text of parse_table_text(). Three columns whose first two make up a regular grid are x, y and z in one unit;
// points that are left out there are not measured. The first line of a matrix has the highest y. Pitch and unit are
// those of `scale`, or else of the header: lines as height_table() writes them, or Gwyddion's ("# Width: 10 um",
// "# Height: 10 um", "# Value units: m"); both is an error. Throws InputError.
SurfaceFile parse_height_table(std::string_view bytes, const std::filesystem::path& file, const ImageScale& scale);

// A matrix of heights in um between commas under a header with pitch, position and provenance; reads back exactly.
std::string height_table(const HeightMap& map, const Provenance& provenance);

} // namespace vkfv::surface
