// Levelling and areal filters. Every function here ignores not-measured points (NaN) and leaves them unchanged.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The plane height = offset + slope_x * (x - x_centre) + slope_y * (y - y_centre), where the centre is the mean
// position of the fitted points, which makes offset their mean height. mm; slopes are dimensionless.
struct Plane {
    double offset = 0;
    double slope_x = 0;
    double slope_y = 0;
    double x_centre = 0;
    double y_centre = 0;

    double height(double x, double y) const { return offset + slope_x * (x - x_centre) + slope_y * (y - y_centre); }
};

// The least-squares plane along z over the measured points. Points on one line leave the tilt across it undetermined:
// it is then zero. Without measured points the offset is NaN.
Plane least_squares_plane(const HeightMap& map);

HeightMap remove_plane(HeightMap map, const Plane& plane);

// The linear areal Gaussian filter of ISO 16610-61, with the weighting function
//   s(x, y) = exp(-pi ((x / (alpha L))^2 + (y / (alpha L))^2)) / (alpha L)^2,  alpha = sqrt(ln 2 / pi),
// where L is the nesting index (cut-off wavelength, mm, positive: std::invalid_argument otherwise), at which half of a
// sinusoid's amplitude passes. The function is cut off at L, where it has fallen to exp(-pi^2/ln 2) = 6.5e-7.
// Near borders and not-measured points the weights present are normalised to one (ISO 16610-28).
// It is computed by weighted sums or by Fourier transforms, whichever takes less time; they agree to 1e-9 of the
// heights' range.
enum class Convolution { by_cost, direct, by_transforms };
HeightMap gaussian_low_pass(const HeightMap& map, double nesting_index, Convolution how = Convolution::by_cost);

// The filter with a weight for each point, from 0 to 1, on the map's grid: the weighting function times these,
// normalised to one. NaN also at points where less than a millionth of a point's own weight remains.
HeightMap weighted_low_pass(const HeightMap& map, const Grid<double>& weights, double nesting_index);

// The L-filter: subtracts the Gaussian low-pass.
HeightMap remove_long_waves(const HeightMap& map, double nesting_index);

} // namespace vkfv::surface
