// The contrast error of images made by optics::PupilFilter, anywhere in the field.
#pragma once

#include "optics/waves/point_waves.hpp"
#include "optics/waves/pupil_filter.hpp"

namespace vkfv::optics {

// The largest contrast error over directions, frequencies below the filter's cutoff and heights within `reach` (mm) of
// z = 0, for a level Lambertian surface. It includes all properties of the point: wavefront, pupil, vignetting, lateral
// colour. 0 at a point without light.
FilterError largest_filter_error(const PupilFilter& filter, const PointWaves& point, double reach);
// The wavefronts of a point of the field (mm in the object) at the wavelengths used to find the contrast error.
PointWaves point_for_filter(const Instrument& instrument, glm::dvec2 field);
double reach_of_filter(const Instrument& instrument); // mm, two depths of field
// The middle of a side of the field, mm in the object.
glm::dvec2 edge_of(const Instrument& instrument);
// The contrast error at a point of the instrument's field (mm in the object) within reach_of_filter(); known errors of
// the filter are reused.
FilterError largest_filter_error(const PupilFilter& filter, const Instrument& instrument, glm::dvec2 field);

// The contrast error on the axis that an automatic number of cells may leave.
inline constexpr double most_error_of_cells = 0.07;
// The contrast error at the edge and in the corner of the field up to which an automatic number of tiles is 1. Above
// it, tiles are to leave at most most_error_of_tiles.
inline constexpr double most_error_of_axis = 0.12;
inline constexpr double most_error_of_tiles = 0.05;
// The filter of an instrument with the options' cells and tiles, for pixels without parts. An automatic number of cells
// is the smallest of 8, 10 ... 16 across the pupil with at most most_error_of_cells on the axis, else 16. An automatic
// number of tiles is 1 if the axis' filter leaves at most most_error_of_axis, or at most one and a half times its error
// on the axis; else the smallest of 3, 5, 7 and 9 across the field with at most most_error_of_tiles on the axis, at the
// edge, in the corner and between tiles. An automatic number of cells then leaves at most four fifths of that on the
// axis, and grows while the tiles' error is too large. Neither number grows where the error hardly falls. Throws
// InputError as PupilFilter does.
PupilFilter filter_for_waves(const Instrument& instrument, const WaveOptions& options = {});

} // namespace vkfv::optics
