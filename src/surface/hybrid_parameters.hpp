// Hybrid parameters of ISO 25178-2:2012, 4.3.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// Hybrid parameters of a sampled surface; the standard leaves open how heights continue between the points. A sinusoid
// of n points a period keeps the share sin(pi / n) / (pi / n) of its slope. sdq is NaN if it lacks a pair along an
// axis, sdr if it lacks a whole cell.
//
// sdq: the mean square of the differences of all neighbouring pairs of measured points along x over the pitch, plus
// that along y, as in Gwyddion, surfalize and SurfaceTopography except for their weights at borders. An egg box of 10
// points a period loses 1.6 %; central differences lose 6.4 %, the mean gradient of each cell's four triangles 4.0 %.
// The seven-point formula of ISO 4287 loses 0.2 % there, but 20 % of slopes whose spectrum is white up to the Nyquist
// frequency, where neighbouring differences lose 14 %; it needs three measured points on either side, and those
// programs do not use it.
//
// sdr: a cell of four measured points is split into two triangles by either diagonal, and the mean of both areas
// counts, so that sdr is sdq^2 / 2 for small slopes: that egg box loses 3.2 %. Gwyddion's four triangles that meet at
// the cell's mean height lose 7.8 %.
struct HybridParameters {
    double sdq = 0; // root mean square gradient
    // The share by which sdq would at least grow with ever finer sampling, by L. Richardson's extrapolation from the
    // differences over one pitch and over two: (1 - sdq(2 pitches) / sdq) / 3, not below 0. Sdr would grow by twice as
    // much. It is accurate for waves of eight points a period and more, and too small for shorter ones and for noise,
    // whose slopes have no limit. NaN if sdq is 0 or lacks pairs.
    double sdq_loss = 0;
    double sdr = 0; // developed interfacial area ratio: area of the surface over that of its projection, minus 1
};

HybridParameters hybrid_parameters(const HeightMap& map);

} // namespace vkfv::surface
