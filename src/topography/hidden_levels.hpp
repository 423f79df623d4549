// Levels of height that a window has at once: two surfaces of a film, or relief that is finer than the window and as
// high as the depth of focus. A focus curve is then a sum of curves, and its maximum may be at the height of none.
//
// Let t(z) be the responses of a measure's masks to the image at z, A(z) their amplitude by defocus, even in z, and p
// the share of the texture's energy at the height h. About any height m,
//
//   P(d) = <t(m - d) t(m + d)> = sum over h of p A(m - d - h) A(m + d - h),
//   E(d) = (<t(m - d)^2> + <t(m + d)^2>) / 2 = sum over h of p (A(m - d - h)^2 + A(m + d - h)^2) / 2.
//
// If all texture is at m, both are A(d)^2, whatever the optics; texture elsewhere makes E wider and not P. For
// Gaussians A = exp(-z^2 / (2 s^2)), P is exp(-d^2 / s^2) of any p, and the second moment of E over d exceeds that of P
// by the mean of (h - m)^2. That is the square of how far the levels are from m. Products of images that share no noise
// tell both. (Places where noise has more than half of the texture's energy are left out.) Spherical aberration makes A
// uneven, and adds a twentieth of the second moment for 0.1 wave.
#pragma once

#include "core/mathematics/grid.hpp"

#include <span>
#include <vector>

namespace vkfv::topography {

// The levels that the focus curves of one place, a pixel of the stack, point to. Variances are in squares of the scan's
// steps.
struct LevelsAtPlace {
    int column = 0;
    int row = 0;
    double variance = 0; // mean square distance of the levels from the focus curve's maximum; also < 0 by noise
    double single = 0;   // second moment of the curve of one level
};

class HiddenLevels {
  public:
    HiddenLevels() = default;
    // height: the map's, in any unit, on whose pixels the places are; step: of the scan, in that unit; radius: of the
    // windows. What a window has by the slope of the map at a place is taken off, since the map shows it. A place has
    // several levels where it and its eight nearest neighbours have: in the median, the variance exceeds the share of
    // `single` that aberrations bring, and the mean is twice its standard error. A step of the surface lies in few of
    // nine places.
    HiddenLevels(std::vector<LevelsAtPlace> places, const Grid<double>& height, double step, int radius);

    // At the place nearest to this pixel: the mean variance of its neighbours, in the unit squared, or 0.
    double variance(int column, int row) const;

    // Root mean square, over all places, of the levels' distance from the maximum, less slopes of the map; in its unit.
    double mean_deviation() const;

  private:
    static constexpr int tiles_a_side = 64;

    int columns_ = 0;
    int rows_ = 0;
    double mean_ = 0;
    Grid<double> tiles_;
};

} // namespace vkfv::topography
