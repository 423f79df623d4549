// Heights as text: a matrix of numbers (csv, txt, asc), or x, y and z of the points of a regular grid (xyz).
#pragma once

#include "surface_files/surface_file.hpp"

#include <string>
#include <string_view>

namespace vkfv::surface {

// True for a name in lower case that ends in .csv, .txt, .asc or .xyz, since no content identifies such a file.
bool named_like_height_table(std::string_view name);

// Reads the text of parse_table_text(). Three columns whose first two form a regular grid are x, y and z in one unit;
// points missing there are not measured. The first line of a matrix has the highest y. Pitch and unit are those of
// `scale`, or else of the header: lines as height_table() writes them, or Gwyddion's ("# Width: 10 um", "# Height: 10
// um", "# Value units: m"); both is an error. Throws InputError.
SurfaceFile parse_height_table(std::string_view bytes, const std::filesystem::path& file, const ImageScale& scale);

// Writes a matrix of heights in um between commas under a header with pitch, position and provenance; it reads back
// exactly.
std::string height_table(const HeightMap& map, const Provenance& provenance);

} // namespace vkfv::surface
