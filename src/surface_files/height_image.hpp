// Height maps as images: those that vkfv wrote, and any other single-channel TIFF or OpenEXR with its scale given.
#pragma once

#include "surface_files/surface_file.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace vkfv::surface {

// A TIFF file: float32 heights in micrometres; NaN means "not measured". The grid's origin and pitch stand in the
// description as text that reads back exactly, since resolution tags are rounded.
std::string height_map_bytes(const HeightMap& map, const Provenance& provenance = {});

// By a file's first bytes.
bool looks_like_height_image(std::string_view bytes);

// The first page. Every value that is not finite is not measured. Without vkfv's own text about pitch and position the
// scale must be given, and the first pixel of the last row stands at x = y = 0. Throws InputError; `path` names the
// file in its message.
SurfaceFile parse_height_image(std::string_view bytes, const std::filesystem::path& path, const ImageScale& scale);

} // namespace vkfv::surface
