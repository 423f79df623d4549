// The areal spline filter.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The smoothing spline s that minimises the sum of (z - s)^2 over the measured points plus mu times the integral of the
// squared Laplacian of s: the isotropic areal counterpart of the linear profile spline without tension of ISO 16610-22.
// mu is chosen so that half of the amplitude passes at the nesting index L (mm, positive: std::invalid_argument
// otherwise); the transmission at the wavelength l is 1 / (1 + (L / l)^4), falling more sharply than the
// Gaussian's, in every direction alike.
//
// Not-measured points have no weight and stay so. Borders mirror: what tilt a map has bends there, so level it first.
// By cosine transforms, in some 70 bytes a point: one pair without gaps; with them a pair each step of the conjugate
// gradients, to 1e-5 of the heights about their mean, of which gaps wider than L take hundreds (545 000 points with 1 %
// of gaps: 4 s). gaussian_low_pass() serves where such gaps are many.
HeightMap spline_low_pass(const HeightMap& map, double nesting_index);

} // namespace vkfv::surface
