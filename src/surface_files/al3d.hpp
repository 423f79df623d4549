// AL3D, the surfaces of Alicona's focus-variation instruments; read only.
#pragma once

#include "surface_files/surface_file.hpp"

#include <string_view>

namespace vkfv::surface {

bool looks_like_al3d(std::string_view bytes);

// Reads the depth map, without texture. Throws InputError.
SurfaceFile parse_al3d(std::string_view bytes, const std::filesystem::path& file);

} // namespace vkfv::surface
