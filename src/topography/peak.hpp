// The maximum of focus curves, to a fraction of a step.
#pragma once

#include "core/grid.hpp"

#include <vector>

namespace vkfv::topography {

// Where a Gaussian through the points (-1, before), (0, at), (1, after) has its maximum:
//   (ln before - ln after) / (2 (ln before - 2 ln at + ln after)),
// exact for a Gaussian. NaN unless all three are positive and `at` is no smaller than its neighbours and
// larger than one of them.
double gaussian_peak_offset(double before, double at, double after);

// Follows the focus curves of all pixels, one image of curve values at a time, and keeps what the fit needs.
class PeakTracker {
  public:
    // The next value of every pixel's curve.
    void add(const Grid<float>& curve_values);

    // Position of the maximum in steps from the first image; NaN where it lies at either end or has no fit.
    double position(int column, int row) const;
    // Maximum less mean of the curve.
    double prominence(int column, int row) const;

  private:
    struct Curve {
        double sum = 0;
        float largest = 0;
        float before = 0; // the largest value's neighbours
        float after = 0;
        float last = 0;
        int at = 0;
    };
    int images_ = 0;
    Grid<Curve> curves_;
};

} // namespace vkfv::topography
