#include "surface/spline_filter.hpp"

#include "surface/filter.hpp"
#include "surface/whole_spline.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace vkfv::surface {
namespace {

// The part that the filter passes unchanged: the mean, or with natural ends the plane. The accuracy goal refers to the
// rest.
Plane passing(const HeightMap& map, SplineEnds ends) {
    Plane plane = least_squares_plane(map);
    if (ends == SplineEnds::mirrored)
        plane.slope_x = plane.slope_y = 0;
    return plane;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        sum += a[k] * b[k];
    return sum;
}

} // namespace

HeightMap spline_low_pass(const HeightMap& map, double nesting_index, SplineEnds ends) {
    if (!(nesting_index > 0))
        throw std::invalid_argument("spline_low_pass: the nesting index must be positive");
    // The equation is (W + B) s = W z, with W 1 at measured points and 0 elsewhere, and B the bending. It is solved by
    // conjugate gradients with the filter of a whole map, (1 + B)^-1, as preconditioner. Without gaps the first step
    // gives the solution.
    const WholeSpline whole(map, nesting_index, ends);
    const std::size_t points = map.height.values.size();
    std::vector<double> weight(points), residual(points), spline(points);
    const Plane plane = passing(map, ends);
    const HeightMap level = remove_plane(map, plane);
    for (std::size_t k = 0; k < points; ++k)
        if (const double z = level.height.values[k]; std::isfinite(z)) {
            weight[k] = 1;
            residual[k] = z;
        }
    const double goal = 1e-10 * dot(residual, residual);      // squared: 1e-5 relative
    std::vector<double> direction(points), stretched(points); // stretched = (1 + B) direction
    double before = 0;
    // In exact arithmetic the number of points would suffice as steps; rounding must not prolong the loop.
    for (std::size_t step = 0; step < points && dot(residual, residual) > goal; ++step) {
        const std::vector<double> smooth = whole.low_pass(residual);
        const double now = dot(residual, smooth);
        const double share = step == 0 ? 0 : now / before;
        before = now;
        std::vector<double> image(points); // (W + B) direction
        for (std::size_t k = 0; k < points; ++k) {
            direction[k] = smooth[k] + share * direction[k];
            stretched[k] = residual[k] + share * stretched[k];
            image[k] = stretched[k] + (weight[k] - 1) * direction[k];
        }
        const double length = now / dot(direction, image);
        for (std::size_t k = 0; k < points; ++k) {
            spline[k] += length * direction[k];
            residual[k] -= length * image[k];
        }
    }
    HeightMap result = map;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column) {
            const std::size_t k = map.height.index(column, row);
            result.height.values[k] = weight[k] > 0 ? plane.height(map.x(column), map.y(row)) + spline[k] : undefined;
        }
    return result;
}

} // namespace vkfv::surface
