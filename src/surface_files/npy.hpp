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

// Reads an array of two dimensions, rows first, of integers or floats of any width and byte order, in C's or Fortran's
// order; its first row has the highest y. Values that are not finite are not measured. `scale` must be given; the first
// point of the last row is at x = y = 0. Throws InputError.
SurfaceFile parse_npy(std::string_view bytes, const std::filesystem::path& file, const ImageScale& scale);

// Writes float64 um, version 1.0; the format holds no pitch, position or provenance.
std::string npy_bytes(const HeightMap& map);

// Writes float32 in C's order, version 1.0. The number of values is the product of `shape`.
std::string npy_bytes(std::span<const float> values, const std::vector<std::size_t>& shape);

} // namespace vkfv::surface
