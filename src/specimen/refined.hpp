// Height fields resampled at the points of other grids, by surface/resample.hpp.
#pragma once

#include "specimen/specimen.hpp"

namespace vkfv::specimen {

// The field at the points of another grid within it; a point counts as interpolated if the nearest one of the field
// does.
HeightField on_grid(const HeightField& field, double x0, double y0, int columns, int rows, double pitch);

// The field on a grid of the finer pitch (mm) of [specimen.roughness], around the same centre. Throws InputError for
// more points than fit into memory.
HeightField refined(const HeightField& field, double pitch, const SourceLocation& where);

} // namespace vkfv::specimen
