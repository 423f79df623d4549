// Focus curves of some pixels on a regular grid, kept whole so that users can see how a height was found.
#pragma once

#include "topography/focus_planes.hpp"
#include "topography/peak_method.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace vkfv::topography {

// The grid of pixels whose curves are kept: so many along x and y, or all pixels where an image has fewer. 4 bytes a
// value.
struct CurveGrid {
    int columns = 0; // 0: none are kept
    int rows = 0;
    int every = 1; // images; values at every so many images are kept

    // The columns and rows of the pixels, evenly spread: number k of n stands at floor((2 k + 1) pixels / (2 n)).
    std::vector<int> columns_of(int image_columns) const;
    std::vector<int> rows_of(int image_rows) const;
};

// The fit by which the maximum was found, over images at - range ... at + range: with x in images from `at`, largest *
// f(c0 + c1 x + c2 x^2), where f is exp for a Gaussian and 1 + ... for a parabola.
struct CurveFit {
    int at = 0;
    int range = 0; // 0: nothing was fitted
    bool gaussian = true;
    double largest = 0;
    std::array<double, 3> coefficients{};
};

struct FocusCurves {
    std::vector<int> columns; // columns of the image, for each of the grid
    std::vector<int> rows;
    std::vector<double> z{};      // mm, heights of the curves' values
    std::vector<float> values{};  // after both averages; [(row * columns + column) * heights + height]
    std::vector<double> peaks{};  // mm, maximum of each curve by the method of the evaluation; NaN: none
    std::vector<CurveFit> fits{}; // fit of each curve; range 0 where not every image's value is kept

    std::size_t index(std::size_t column, std::size_t row) const { return row * columns.size() + column; }
};

// The fit of a curve. curve: its values at all images; at: the image of the largest; range: of the evaluation.
CurveFit fit_of(PeakMethod method, const std::vector<double>& curve, int at, int range);

} // namespace vkfv::topography
