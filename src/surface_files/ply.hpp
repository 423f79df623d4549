// PLY, the polygon file format of mesh viewers; written only.
#pragma once

#include "surface_files/surface_file.hpp"

#include <string>

namespace vkfv::surface {

// Writes binary, little-endian PLY: the measured points as vertices (x, y, z in mm, float32), row by row from the
// lowest y, and two triangles a cell, counter-clockwise seen from +z, split from (i, j) to (i+1, j+1) like a specimen's
// facets; triangles with a not-measured corner are left out. RunError for more points than the format's indices can
// count.
std::string ply_bytes(const HeightMap& map, const Provenance& provenance);

} // namespace vkfv::surface
