#include "surface/spline_filter.hpp"

#include "core/fourier.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace vkfv::surface {
namespace {

// The filter of a whole map: the inverse of 1 + mu Laplacian^2 under mirrored borders.
std::vector<double> whole_low_pass(std::vector<double> heights, const HeightMap& map, double nesting_index) {
    Grid<double> grid;
    grid.columns = map.columns();
    grid.rows = map.rows();
    grid.values = std::move(heights);
    cosine_transform(grid);
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const double frequency =
                std::hypot(column / (2 * grid.columns * map.pitch_x), row / (2 * grid.rows * map.pitch_y));
            grid(column, row) /= 1 + std::pow(nesting_index * frequency, 4);
        }
    inverse_cosine_transform(grid);
    return std::move(grid.values);
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        sum += a[k] * b[k];
    return sum;
}

} // namespace

HeightMap spline_low_pass(const HeightMap& map, double nesting_index) {
    if (!(nesting_index > 0))
        throw std::invalid_argument("spline_low_pass: the nesting index must be positive");
    // (W + mu B) s = W z, W 1 at measured points and 0 elsewhere, B the squared Laplacian: conjugate gradients with the
    // filter of a whole map, (1 + mu B)^-1, as preconditioner. Without gaps its first step is the solution.
    const std::size_t points = map.height.values.size();
    std::vector<double> weight(points), residual(points), spline(points);
    // The filter passes the mean as it is; the goal is one of the heights about it.
    double sum = 0, count = 0;
    for (const double z : map.height.values)
        if (std::isfinite(z)) {
            sum += z;
            count += 1;
        }
    const double mean = sum / count;
    for (std::size_t k = 0; k < points; ++k)
        if (const double z = map.height.values[k]; std::isfinite(z)) {
            weight[k] = 1;
            residual[k] = z - mean;
        }
    const double goal = 1e-10 * dot(residual, residual);      // squared: a relative 1e-5
    std::vector<double> direction(points), stretched(points); // stretched = (1 + mu B) direction
    double before = 0;
    // As many steps as points would end it but for rounding, which must not keep it going.
    for (std::size_t step = 0; step < points && dot(residual, residual) > goal; ++step) {
        const std::vector<double> smooth = whole_low_pass(residual, map, nesting_index);
        const double now = dot(residual, smooth);
        const double share = step == 0 ? 0 : now / before;
        before = now;
        std::vector<double> image(points); // (W + mu B) direction
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
    for (std::size_t k = 0; k < points; ++k)
        result.height.values[k] = weight[k] > 0 ? mean + spline[k] : std::numeric_limits<double>::quiet_NaN();
    return result;
}

} // namespace vkfv::surface
