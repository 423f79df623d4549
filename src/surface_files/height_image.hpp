// Height maps as images: those that vkfv wrote, and other single-channel TIFF or OpenEXR images with a given scale.
#pragma once

#include "surface_files/surface_file.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace vkfv::surface {

// Writes a TIFF file of float32 heights in micrometres; NaN means "not measured". The grid's origin and pitch are text
// in the description, which reads back exactly, since resolution tags are rounded.
std::string height_map_bytes(const HeightMap& map, const Provenance& provenance = {});

// Decides by a file's first bytes.
bool looks_like_height_image(std::string_view bytes);

// Reads the first page. Values that are not finite are not measured. Without vkfv's own text about pitch and position
// the scale must be given, and the first pixel of the last row is at x = y = 0. Throws InputError; `path` names the
// file in its message.
SurfaceFile parse_height_image(std::string_view bytes, const std::filesystem::path& path, const ImageScale& scale);

} // namespace vkfv::surface
