// How far the contrast of images as optics::PupilFilter makes them is from that of waves, anywhere in the field.
#pragma once

#include "optics/point_waves.hpp"
#include "optics/pupil_filter.hpp"

#include <complex>

namespace vkfv::optics {

struct FilterError {
    double difference = 0;                                   // |filtered - waves|
    glm::dvec2 frequency = glm::dvec2(0);                    // where it is largest, cycles per mm of the object
    double height = 0;                                       // of the object plane above z = 0, mm
    std::complex<double> waves = std::complex<double>(0);    // Hopkins' transfer function of this point of the field
    std::complex<double> filtered = std::complex<double>(0); // what the axis' filter makes of this point's rays
};

// The largest over directions, frequencies up to the filter's cutoff and heights within `reach` (mm) of z = 0, for a
// Lambertian surface that stands level. All of the point's own counts: wavefront, pupil, vignetting, lateral colour.
// A point that no light comes from has none.
FilterError largest_filter_error(const PupilFilter& filter, const PointWaves& point, double reach);
// The same of a point of the instrument's field (mm in the object), within two depths of field.
FilterError largest_filter_error(const PupilFilter& filter, const Instrument& instrument, glm::dvec2 field);

// What the cells may leave of that on the axis where their number is not asked for.
inline constexpr double most_error_of_cells = 0.07;
// With the fewest cells of 8, 10 ... 16 across the pupil that leave no more, or 16; of pixels that are not parted.
// Throws as PupilFilter.
PupilFilter filter_for_waves(const Instrument& instrument);

} // namespace vkfv::optics
