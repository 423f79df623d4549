// How far the contrast of images as optics::PupilFilter makes them is from that of waves, anywhere in the field.
#pragma once

#include "optics/waves/point_waves.hpp"
#include "optics/waves/pupil_filter.hpp"

namespace vkfv::optics {

// The largest over directions, frequencies up to the filter's cutoff and heights within `reach` (mm) of z = 0, for a
// Lambertian surface that stands level. All of the point's own counts: wavefront, pupil, vignetting, lateral colour.
// A point that no light comes from has none.
FilterError largest_filter_error(const PupilFilter& filter, const PointWaves& point, double reach);
// The wavelengths of a point of the field (mm in the object) that this is found with.
PointWaves point_for_filter(const Instrument& instrument, glm::dvec2 field);
double reach_of_filter(const Instrument& instrument); // two depths of field, mm
// The middle of a side of the field, mm in the object.
glm::dvec2 edge_of(const Instrument& instrument);
// The same of a point of the instrument's field (mm in the object), within that.
FilterError largest_filter_error(const PupilFilter& filter, const Instrument& instrument, glm::dvec2 field);

// What the cells may leave of that on the axis where their number is not asked for.
inline constexpr double most_error_of_cells = 0.07;
// The filter of the axis may leave so much error at the edge and in the corner of the field where the number of tiles
// is not asked for. Where it leaves more, tiles are to leave no more than most_error_of_tiles.
inline constexpr double most_error_of_axis = 0.12;
inline constexpr double most_error_of_tiles = 0.05;
// A filter with the cells and tiles that are asked for, of pixels that are not parted. If cells are not: with the
// fewest of 8, 10 ... 16 across the pupil that leave no more than that on the axis, or 16. If tiles are not: one where
// the axis' filter is good enough, or not half as far off again as on the axis; else the fewest of 3, 5, 7 and 9 across
// the field that leave no more than most_error_of_tiles on the axis, at the edge, in the corner and between tiles.
// Cells that are not asked for are then as many as leave four fifths of that on the axis, and more where the tiles are
// not good enough. More of either are not taken where they are hardly better. Throws as PupilFilter.
PupilFilter filter_for_waves(const Instrument& instrument, const WaveOptions& options = {});

} // namespace vkfv::optics
