#include "specimen/refined.hpp"

#include "specimen/files.hpp"

#include "core/mathematics/units.hpp"
#include "surface/resample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vkfv::specimen {

HeightField on_grid(const HeightField& field, double x0, double y0, int columns, int rows, double pitch) {
    surface::HeightMap map{.height = Grid<double>(field.heights.columns, field.heights.rows),
                           .x0 = field.x_min,
                           .y0 = field.y_min,
                           .pitch_x = field.pitch_x,
                           .pitch_y = field.pitch_y};
    std::copy(field.heights.values.begin(), field.heights.values.end(), map.height.values.begin());
    const surface::HeightMap resampled = surface::resampled(
        map, {.height = Grid<double>(columns, rows), .x0 = x0, .y0 = y0, .pitch_x = pitch, .pitch_y = pitch});
    HeightField result{
        .heights = Grid<float>(columns, rows), .x_min = x0, .y_min = y0, .pitch_x = pitch, .pitch_y = pitch};
    std::ranges::transform(resampled.height.values, result.heights.values.begin(),
                           [](double height) { return static_cast<float>(height); });
    if (!field.interpolated.empty()) {
        const auto nearest = [](double at, double first, double step, int count) {
            return std::clamp(static_cast<int>(std::lround((at - first) / step)), 0, count - 1);
        };
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column)
                result.interpolated.push_back(field.interpolated[field.heights.index(
                    nearest(x0 + column * pitch, field.x_min, field.pitch_x, field.heights.columns),
                    nearest(y0 + row * pitch, field.y_min, field.pitch_y, field.heights.rows))]);
    }
    return result;
}

HeightField refined(const HeightField& field, double pitch, const SourceLocation& where) {
    const double width = field.x_max() - field.x_min, height = field.y_max() - field.y_min;
    const auto points = [pitch](double extent) { return std::floor(extent / pitch * (1 + 1e-9)) + 1; };
    if (!(points(width) * points(height) <= static_cast<double>(largest_point_count))) {
        const double least = std::sqrt(width * height / static_cast<double>(largest_point_count));
        throw InputError(
            {where, "specimen.roughness.pitch_um", fmt::format("{:.6g}", pitch * um_per_mm),
             fmt::format("at most {} points on the file's {:.6g} x {:.6g} mm", largest_point_count, width, height),
             fmt::format("Choose roughness.pitch_um >= {:.3g}.", 1.01 * least * um_per_mm)});
    }
    const int columns = static_cast<int>(points(width)), rows = static_cast<int>(points(height));
    // The finer grid has the same centre.
    return on_grid(field, 0.5 * (field.x_min + field.x_max() - (columns - 1) * pitch),
                   0.5 * (field.y_min + field.y_max() - (rows - 1) * pitch), columns, rows, pitch);
}

} // namespace vkfv::specimen
