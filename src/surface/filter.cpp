#include "surface/filter.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace vkfv::surface {
namespace {

// The weights[r + k] of points k pitches away, k in -r..r; r is limited by an axis of so many points. They are not
// normalised: the caller divides by the weights present.
std::vector<double> gaussian_weights(double nesting_index, double pitch, int points) {
    const double alpha = std::sqrt(std::numbers::ln2 / pi);
    const int radius = static_cast<int>(std::min(std::floor(nesting_index / pitch), std::max(points - 1.0, 0.0)));
    std::vector<double> weights(static_cast<std::size_t>(2 * radius + 1));
    for (int k = -radius; k <= radius; ++k) {
        const double u = k * pitch / (alpha * nesting_index);
        weights[static_cast<std::size_t>(k + radius)] = std::exp(-pi * u * u);
    }
    return weights;
}

Grid<double> convolve_columns(const Grid<double>& grid, const std::vector<double>& weights) {
    const int radius = static_cast<int>(weights.size() / 2);
    Grid<double> result(grid.columns, grid.rows);
    for (int row = 0; row < grid.rows; ++row)
        for (int source = std::max(0, row - radius); source <= std::min(grid.rows - 1, row + radius); ++source) {
            const double weight = weights[static_cast<std::size_t>(source - row + radius)];
            for (int column = 0; column < grid.columns; ++column)
                result(column, row) += weight * grid(column, source);
        }
    return result;
}

Grid<double> convolve_rows(const Grid<double>& grid, const std::vector<double>& weights) {
    const int radius = static_cast<int>(weights.size() / 2);
    Grid<double> result(grid.columns, grid.rows);
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            double sum = 0;
            for (int source = std::max(0, column - radius); source <= std::min(grid.columns - 1, column + radius);
                 ++source)
                sum += weights[static_cast<std::size_t>(source - column + radius)] * grid(source, row);
            result(column, row) = sum;
        }
    return result;
}

// The largest number of weights, both axes together, for which direct sums are faster than transforms.
constexpr std::size_t most_direct_weights = 120;

// Filters by one convolution, with heights as its real part and measured points as its imaginary part. A measured
// point's own weight is one, so dividing by the sum of weights does not magnify rounding. `weights`: one for each
// point; null: all 1.
HeightMap low_pass_by_transforms(const HeightMap& map, const std::vector<double>& along_x,
                                 const std::vector<double>& along_y, const Grid<double>* weights = nullptr) {
    constexpr double least_weight = 1e-6;
    // Scaled to their greatest distance from one of them, heights have the same rounding as their weights, and a
    // constant stays constant.
    double level = undefined, greatest = 0;
    for (const double z : map.height.values)
        if (std::isfinite(z)) {
            if (std::isnan(level))
                level = z;
            greatest = std::max(greatest, std::abs(z - level));
        }
    const double unit = greatest > 0 ? greatest : 1;
    Grid<std::complex<double>> grid(map.columns(), map.rows());
    for (std::size_t k = 0; k < grid.values.size(); ++k)
        if (const double z = map.height.values[k]; std::isfinite(z)) {
            const double weight = weights != nullptr ? weights->values[k] : 1;
            grid.values[k] = {weight * (z - level) / unit, weight};
        }
    const auto outwards = [](const std::vector<double>& weights) {
        return std::vector<double>(weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2), weights.end());
    };
    convolve(grid, outwards(along_x), outwards(along_y));
    HeightMap result = map;
    for (std::size_t k = 0; k < grid.values.size(); ++k)
        if (double& z = result.height.values[k]; std::isfinite(z) && grid.values[k].imag() > least_weight)
            z = level + unit * grid.values[k].real() / grid.values[k].imag();
        else
            z = undefined;
    return result;
}

} // namespace

Plane least_squares_plane(const HeightMap& map) {
    // Centred sums in a second pass avoid cancellation.
    double count = 0, sum_x = 0, sum_y = 0, sum_z = 0;
    const auto over_measured = [&map](auto&& visit) {
        for (int row = 0; row < map.rows(); ++row)
            for (int column = 0; column < map.columns(); ++column)
                if (const double z = map.height(column, row); std::isfinite(z))
                    visit(map.x(column), map.y(row), z);
    };
    over_measured([&](double x, double y, double z) {
        count += 1;
        sum_x += x;
        sum_y += y;
        sum_z += z;
    });
    Plane plane{.offset = std::numeric_limits<double>::quiet_NaN()};
    if (count == 0)
        return plane;
    plane.x_centre = sum_x / count;
    plane.y_centre = sum_y / count;
    plane.offset = sum_z / count;

    double xx = 0, xy = 0, yy = 0;
    over_measured([&](double x, double y, double) {
        const double dx = x - plane.x_centre, dy = y - plane.y_centre;
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    });
    // The normal equations use the axes along and across the points' largest extent, which reveals points on a line
    // however long it is.
    constexpr double line = 1e-10; // ratio of extents across and along; less is rounding
    const double angle = std::atan2(2 * xy, xx - yy) / 2, cosine = std::cos(angle), sine = std::sin(angle);
    double uu = 0, uv = 0, vv = 0, uz = 0, vz = 0;
    over_measured([&](double x, double y, double z) {
        const double dx = x - plane.x_centre, dy = y - plane.y_centre, dz = z - plane.offset;
        const double u = cosine * dx + sine * dy, v = cosine * dy - sine * dx;
        uu += u * u;
        uv += u * v;
        vv += v * v;
        uz += u * dz;
        vz += v * dz;
    });
    double along = 0, across = 0;
    if (vv > line * line * uu) {
        const double determinant = uu * vv - uv * uv;
        along = (vv * uz - uv * vz) / determinant;
        across = (uu * vz - uv * uz) / determinant;
    } else if (uu > 0) {
        along = uz / uu;
    }
    plane.slope_x = cosine * along - sine * across;
    plane.slope_y = sine * along + cosine * across;
    return plane;
}

HeightMap remove_plane(HeightMap map, const Plane& plane) {
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            map.height(column, row) -= plane.height(map.x(column), map.y(row));
    return map;
}

HeightMap gaussian_low_pass(const HeightMap& map, double nesting_index, Convolution how) {
    if (!(nesting_index > 0))
        throw std::invalid_argument("gaussian_low_pass: the nesting index must be positive");
    const auto along_x = gaussian_weights(nesting_index, map.pitch_x, map.columns());
    const auto along_y = gaussian_weights(nesting_index, map.pitch_y, map.rows());
    if (how == Convolution::by_cost)
        how = along_x.size() + along_y.size() > most_direct_weights ? Convolution::by_transforms : Convolution::direct;
    if (how == Convolution::by_transforms)
        return low_pass_by_transforms(map, along_x, along_y);
    Grid<double> values(map.columns(), map.rows());
    Grid<double> present(map.columns(), map.rows());
    for (std::size_t k = 0; k < values.values.size(); ++k)
        if (const double z = map.height.values[k]; std::isfinite(z)) {
            values.values[k] = z;
            present.values[k] = 1;
        }
    const auto convolve_directly = [&](const Grid<double>& grid) {
        return convolve_columns(convolve_rows(grid, along_x), along_y);
    };
    const Grid<double> sum = convolve_directly(values);
    const Grid<double> weight = convolve_directly(present);
    HeightMap result = map;
    for (std::size_t k = 0; k < result.height.values.size(); ++k)
        result.height.values[k] = std::isfinite(map.height.values[k]) ? sum.values[k] / weight.values[k] : undefined;
    return result;
}

HeightMap weighted_low_pass(const HeightMap& map, const Grid<double>& weights, double nesting_index) {
    if (!(nesting_index > 0))
        throw std::invalid_argument("weighted_low_pass: the nesting index must be positive");
    return low_pass_by_transforms(map, gaussian_weights(nesting_index, map.pitch_x, map.columns()),
                                  gaussian_weights(nesting_index, map.pitch_y, map.rows()), &weights);
}

HeightMap remove_long_waves(const HeightMap& map, double nesting_index) {
    HeightMap result = gaussian_low_pass(map, nesting_index);
    for (std::size_t k = 0; k < result.height.values.size(); ++k)
        result.height.values[k] = map.height.values[k] - result.height.values[k];
    return result;
}

} // namespace vkfv::surface
