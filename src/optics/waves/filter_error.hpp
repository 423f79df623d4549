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
// The same of a point of the instrument's field (mm in the object), within that.
FilterError largest_filter_error(const PupilFilter& filter, const Instrument& instrument, glm::dvec2 field);

// What the cells may leave of that on the axis where their number is not asked for.
inline constexpr double most_error_of_cells = 0.07;
// With the fewest cells of 8, 10 ... 16 across the pupil that leave no more, or 16; of pixels that are not parted.
// Throws as PupilFilter.
PupilFilter filter_for_waves(const Instrument& instrument);

} // namespace vkfv::optics
