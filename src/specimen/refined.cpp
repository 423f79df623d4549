#include "specimen/analytic.hpp"

#include "surface/resample.hpp"

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
    HeightField result{.heights = Grid<float>(columns, rows), .x_min = x0, .y_min = y0, .pitch_x = pitch, .pitch_y = pitch};
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

HeightField refined(const HeightField& field, double pitch) {
    const auto points = [pitch](double extent) { return static_cast<int>(std::floor(extent / pitch * (1 + 1e-9))) + 1; };
    const int columns = points(field.x_max() - field.x_min), rows = points(field.y_max() - field.y_min);
    // Around the same centre.
    return on_grid(field, 0.5 * (field.x_min + field.x_max() - (columns - 1) * pitch),
                   0.5 * (field.y_min + field.y_max() - (rows - 1) * pitch), columns, rows, pitch);
}

} // namespace vkfv::specimen
