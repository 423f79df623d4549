// Hidden levels: several heights within one window, such as two surfaces of a film, or relief that is finer than the
// window and as high as the depth of focus. A focus curve is then a sum of curves, and its maximum may be at none of
// the heights.
//
// Let t(z) be the responses of a measure's masks to the image at z, A(z) their amplitude by defocus, even in z, and p
// the share of the texture's energy at the height h. About any height m,
//
//   P(d) = <t(m - d) t(m + d)> = sum over h of p A(m - d - h) A(m + d - h),
//   E(d) = (<t(m - d)^2> + <t(m + d)^2>) / 2 = sum over h of p (A(m - d - h)^2 + A(m + d - h)^2) / 2.
//
// If all texture is at m, both are A(d)^2, whatever the optics; texture elsewhere makes E wider but not P. For
// Gaussians A = exp(-z^2 / (2 s^2)), P is exp(-d^2 / s^2) for any p, and the second moment of E over d exceeds that of
// P by the mean of (h - m)^2: the mean square distance of the levels from m. Both are found from products of images
// that share no noise. (Places where noise has more than half of the texture's energy are left out.) Spherical
// aberration makes A uneven, and adds a twentieth of the second moment for 0.1 wave.
#pragma once

#include "core/mathematics/grid.hpp"

#include <span>
#include <vector>

namespace vkfv::topography {

// The levels of height that the focus curves of one place indicate. Variances are in squares of the scan's steps.
struct LevelsAtPlace {
    int column = 0;
    int row = 0;
    double variance = 0; // mean square distance of the levels from the focus curve's maximum; noise may make it < 0
    double single = 0;   // second moment of the curve of one level
};

class HiddenLevels {
  public:
    HiddenLevels() = default;
    // height: the map, in any unit, with the places on its pixels; step: of the scan, in that unit; radius: of the
    // windows. The variance within a window by the map's slope is subtracted, since the map shows it. A place has
    // several levels if it and its eight nearest neighbours have: the median of their variances exceeds the share of
    // `single` that aberrations cause, and the mean is twice its standard error. A step of the surface lies in few of
    // nine places.
    HiddenLevels(std::vector<LevelsAtPlace> places, const Grid<double>& height, double step, int radius);

    // The mean variance of the neighbours of the place nearest to this pixel, in the unit squared, or 0.
    double variance(int column, int row) const;

    // Root mean square, over all places, of the levels' distance from the maximum, less slopes of the map; in the map's
    // unit.
    double mean_deviation() const;

  private:
    static constexpr int tiles_a_side = 64;

    int columns_ = 0;
    int rows_ = 0;
    double mean_ = 0;
    Grid<double> tiles_;
};

} // namespace vkfv::topography
