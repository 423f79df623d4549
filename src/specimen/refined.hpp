// Height fields at the points of other grids, by surface/resample.hpp.
#pragma once

#include "specimen/specimen.hpp"

namespace vkfv::specimen {

// The field at the points of another grid within it; a point is interpolated where the nearest one of the field is.
HeightField on_grid(const HeightField& field, double x0, double y0, int columns, int rows, double pitch);

// The same on a grid of a finer pitch, that of [specimen.roughness], around the same centre. Throws InputError for more
// points than fit into memory.
HeightField refined(const HeightField& field, double pitch, const SourceLocation& where);

} // namespace vkfv::specimen
