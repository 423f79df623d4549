// NPY, arrays of NumPy (numpy.lib.format: versions 1.0 to 3.0).
#pragma once

#include "surface_files/surface_file.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vkfv::surface {

bool looks_like_npy(std::string_view bytes);

// An array of two dimensions, rows first, of integers or floats of any width and byte order, in C's or Fortran's
// order; its first row has the highest y. What is not finite is not measured. `scale` must be given, the first point of
// the last row stands at x = y = 0. Throws InputError.
SurfaceFile parse_npy(std::string_view bytes, const std::filesystem::path& file, const ImageScale& scale);

// Float64 um, version 1.0; pitch, position and provenance have no place in it.
std::string npy_bytes(const HeightMap& map);

// Float32 in C's order, version 1.0. shape: of its product there must be as many values.
std::string npy_bytes(std::span<const float> values, const std::vector<std::size_t>& shape);

} // namespace vkfv::surface
