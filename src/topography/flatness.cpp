#include "topography/flatness.hpp"

#include "core/threads/parallel_rows.hpp"
#include "surface/band.hpp"
#include "surface/height_parameters.hpp"
#include "surface/polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vkfv::topography {

double flatness_deviation(const surface::HeightMap& flat, double s_filter) {
    return surface::height_parameters(surface::scale_limited(flat, {.s_filter = s_filter})).sz;
}

FlatnessCorrected correct_flatness(surface::HeightMap measured, const surface::HeightMap& flat) {
    if (measured.columns() != flat.columns() || measured.rows() != flat.rows())
        throw std::invalid_argument("correct_flatness: both height maps must stand on the same grid");
    const surface::Polynomial deviation = surface::least_squares_polynomial(flat, flatness_degree);
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    // The deviation is taken at the flat's positions: the instrument's field is the same, whatever origin a file gives
    // it.
    for (int row = 0; row < measured.rows(); ++row)
        for (int column = 0; column < measured.columns(); ++column) {
            double& height = measured.height(column, row);
            const double removed = deviation.height(flat.x(column), flat.y(row));
            if (std::isfinite(height)) {
                lowest = std::min(lowest, removed);
                highest = std::max(highest, removed);
            }
            height -= removed;
        }
    return {.heights = std::move(measured), .polynomial_peak_to_valley = highest > lowest ? highest - lowest : 0};
}

double add_curvature(Grid<double>& uncertainty, const surface::HeightMap& measured,
                     const std::function<double(double x, double y)>& curvature) {
    if (uncertainty.columns != measured.columns() || uncertainty.rows != measured.rows())
        throw std::invalid_argument("add_curvature: uncertainty and heights must stand on the same grid");
    Grid<double> field(measured.columns(), measured.rows(), std::numeric_limits<double>::quiet_NaN());
    parallel_rows(field.columns, field.rows, [&](int first, int end) {
        for (int row = first; row < end; ++row)
            for (int column = 0; column < field.columns; ++column)
                if (std::isfinite(measured.height(column, row)))
                    field(column, row) = curvature(measured.x(column), measured.y(row));
    });
    double sum = 0, lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    std::size_t points = 0;
    for (const double height : field.values)
        if (std::isfinite(height)) {
            sum += height;
            lowest = std::min(lowest, height);
            highest = std::max(highest, height);
            ++points;
        }
    if (points == 0)
        return 0;
    const double mean = sum / static_cast<double>(points);
    for (std::size_t k = 0; k < field.values.size(); ++k)
        uncertainty.values[k] = std::hypot(uncertainty.values[k], field.values[k] - mean);
    return highest - lowest;
}

} // namespace vkfv::topography
