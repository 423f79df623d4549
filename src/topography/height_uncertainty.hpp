// How far a measured height may be off, told by the heights themselves: what windows side by side do not agree on.
//
// A window's height is a mean over its texture. It is off the window's mean height by the images' noise, by texture
// that is in focus elsewhere than the surface (glints, unresolved structure), and by relief that the texture has an
// uneven share of. All of these differ from pixel to pixel within the window, so windows that share only a part of
// their pixels have other errors. Let the error of a height be the window's mean of independent errors of pixels, and r
// the distance of a height from the mean of the heights around it, over a reference window half as wide again. With k
// and m the weights of window and reference, of sum 1 each, and * convolution,
//
//   var(r) / var(error) = |k - k*m|^2 / |k|^2,
//
// 0.5 for a box. So the mean of r^2 around a point tells the variance of the error there, of noise with all the rest.
// Relief that the window resolves adds to r, which makes the uncertainty too large on rough surfaces; errors that
// pixels near each other have in common make it too small. The reference's width is between the two: on the example
// stacks (docs/validation.md) a reference of the window's own width told 0.6 to 0.9 of the deviations. What all windows
// have in common (a scale error of the stage, a curved field) does not show, nor how far single points of a relief much
// finer than the window are off the window's mean.
#pragma once

#include "core/mathematics/grid.hpp"
#include "topography/focus_measure.hpp"

namespace vkfv::topography {

// As wide as three halves of the window of this width.
FocusWindow reference_window(int width_px, WindowShape shape);

// var(r) / var(error), above; of a window of 3 pixels or more.
double scatter_share(const FocusWindow& window, const FocusWindow& reference);

// Standard uncertainty of every finite height, in its unit; NaN elsewhere. r is taken from the plane that fits the
// heights in the reference, so that a slope counts nothing beside gaps either, where at least half of it has heights;
// its square is averaged over twice the window's reach, or over the whole map where there is none in it. Not below
// `noise`, the standard deviation by the images' noise (NaN: unknown). Both grids are of one size:
// std::invalid_argument otherwise.
Grid<double> height_uncertainty(const Grid<double>& height, const Grid<double>& noise, int window_px,
                                WindowShape shape);

} // namespace vkfv::topography
