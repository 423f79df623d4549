// The areal spline filter.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

enum class SplineEnds {
    natural, // ISO 16610-22: beyond the ends nothing bends, a plane passes unchanged
    mirrored // the map goes on mirrored about its edges: what tilt it has bends there
};

// The smoothing spline s that minimises the sum of (z - s)^2 over the measured points plus a bending energy, the
// isotropic areal counterpart of the linear profile spline without tension of ISO 16610-22; L is the nesting index (mm,
// positive: std::invalid_argument otherwise), at which half of the amplitude passes.
//
// Natural ends: the energy is a_x^4 (s_xx)^2 + 2 a_x^2 a_y^2 (s_xy)^2 + a_y^4 (s_yy)^2, summed over the differences
// that lie within the map, a = 1 / (2 sin(pi pitch / L)). Of one row that is the standard's equation; of the wavelength
// l passes 1 / (1 + (sin(pi pitch / l) / sin(pi pitch / L))^4) along an axis. Mirrored ends: mu times the squared
// Laplacian; 1 / (1 + (L / l)^4) passes. Both fall more sharply than the Gaussian's, in every direction alike.
//
// Not-measured points have no weight and stay so. By cosine transforms, in some 90 bytes a point: one pair without
// gaps; with them a pair each step of the conjugate gradients, to 1e-5 of the heights about their mean or plane, of
// which gaps wider than L take hundreds. gaussian_low_pass() serves where such gaps are many.
HeightMap spline_low_pass(const HeightMap& map, double nesting_index, SplineEnds ends = SplineEnds::natural);

} // namespace vkfv::surface
