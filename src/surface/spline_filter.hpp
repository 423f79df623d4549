// The areal spline filter.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

enum class SplineEnds {
    natural, // ISO 16610-22: no bending beyond the ends, a plane passes unchanged
    mirrored // the map is continued by reflection, so its tilt bends at the edges
};

// The smoothing spline s that minimises the sum of (z - s)^2 over the measured points plus a bending energy, the
// isotropic areal counterpart of the linear profile spline without tension of ISO 16610-22; L is the nesting index (mm,
// positive: std::invalid_argument otherwise), at which half of the amplitude passes.
//
// Natural ends: the energy is a_x^4 (s_xx)^2 + 2 a_x^2 a_y^2 (s_xy)^2 + a_y^4 (s_yy)^2, summed over the differences
// that lie within the map, a = 1 / (2 sin(pi pitch / L)). For one row this is the standard's equation; along an axis
// the share 1 / (1 + (sin(pi pitch / l) / sin(pi pitch / L))^4) of the wavelength l passes. Mirrored ends: the energy
// is mu times the squared Laplacian; 1 / (1 + (L / l)^4) passes. Both transmissions are isotropic and steeper than the
// Gaussian's.
//
// Not-measured points have no weight and stay so. The spline is computed by cosine transforms, with some 90 bytes a
// point: one pair of transforms without gaps; with gaps one pair for each step of the conjugate gradients, to 1e-5 of
// the heights relative to their mean or plane. Gaps wider than L take hundreds of steps; gaussian_low_pass() is
// better where such gaps are many.
HeightMap spline_low_pass(const HeightMap& map, double nesting_index, SplineEnds ends = SplineEnds::natural);

} // namespace vkfv::surface
