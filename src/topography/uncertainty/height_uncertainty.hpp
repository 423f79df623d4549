// The standard uncertainty of measured heights, from the heights themselves: from the disagreement of neighbouring
// windows.
//
// A window's height is a mean over its texture. It deviates from the window's mean height by the images' noise, by
// texture that is in focus elsewhere than the surface (glints, unresolved structure), and by relief of which the
// texture has an uneven share. All of these differ from pixel to pixel within the window, so windows that share only a
// part of
// their pixels have other errors. Let the error of a height be the window's mean of errors of pixels, whose correlation
// is C(d) at the distance d, and r the distance of a height from the surface of second degree that fits the heights
// around it, over a reference window half as wide again. With k the weights of the window, of sum 1, m those of the
// heights around in the surface's middle, * convolution, and <f> = sum over x, d of f(x) f(x + d) C(d),
//
//   var(r) / var(error) = <k - k*m> / <k>,
//
// 0.26 for a box and errors that are independent from pixel to pixel. Noise has such errors, and its part of var(r) is
// subtracted. The rest has the texture's grains: a grain wider than a pixel makes the errors of neighbours alike
// (texture_grain.hpp), of which r shows less. So the mean of r^2 around a point gives the variance of the error there.
// Relief that the window resolves and a surface of second degree does not follow adds to r. Errors that all windows
// have in common (a scale error of the stage, a curved field) do not show, nor does the deviation of single points of a
// relief much finer than the window from the window's mean.
#pragma once

#include "core/mathematics/grid.hpp"
#include "topography/focus_measure.hpp"

namespace vkfv::topography {

// The reference window, three halves as wide as the window of this width.
FocusWindow reference_window(int width_px, WindowShape shape);

// The correlation of errors that are independent from pixel to pixel: 1 in the middle, 0 around it.
const Grid<double>& independent_errors();

// The ratio var(r) / var(error) (above), for a window of 3 pixels or more. correlation: C, with its middle in that of
// the grid.
double scatter_share(const FocusWindow& window, const FocusWindow& reference,
                     const Grid<double>& correlation = independent_errors());

// The standard uncertainty of every finite height, in its unit; NaN elsewhere. r is computed where the reference lies
// in the map and at least half of it has heights; its square is averaged over twice the window's reach, or over the
// whole map where none is within this reach. noise: the standard deviation by the images' noise (NaN: unknown), a lower
// bound of the uncertainty; grains: the correlation of the errors that remain. height and noise are of one size:
// std::invalid_argument otherwise.
Grid<double> height_uncertainty(const Grid<double>& height, const Grid<double>& noise, int window_px, WindowShape shape,
                                const Grid<double>& grains = independent_errors());

} // namespace vkfv::topography
