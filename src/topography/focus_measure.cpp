#include "topography/focus_measure.hpp"

#include "core/error.hpp"
#include "topography/parallel_rows.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace vkfv::topography {
namespace {

// |2I - I(x-1) - I(x+1)| + |2I - I(y-1) - I(y+1)|
Grid<float> modified_laplacian(const Grid<float>& image) {
    const auto mirrored = [](int k, int count) {
        const int folded = k < 0 ? -k : k >= count ? 2 * (count - 1) - k : k;
        return std::clamp(folded, 0, count - 1); // a single row or column has no neighbour but itself
    };
    Grid<float> result(image.columns, image.rows);
    parallel_rows(image.columns, image.rows, [&](int first, int end) {
        for (int row = first; row < end; ++row) {
            const int below = mirrored(row - 1, image.rows), above = mirrored(row + 1, image.rows);
            for (int column = 0; column < image.columns; ++column) {
                const int left = mirrored(column - 1, image.columns),
                          right = mirrored(column + 1, image.columns);
                const float twice = 2 * image(column, row);
                result(column, row) = std::abs(twice - image(left, row) - image(right, row)) +
                                      std::abs(twice - image(column, below) - image(column, above));
            }
        }
    });
    return result;
}

// Calls visit(column, row, mean) for the mean of value(column, row) over the window, cut off at the border.
// Columns are summed anew for every row and rows by a running sum: O(window) a pixel, no matter which thread.
template <class Value, class Visit>
void window_means(int columns, int rows, int window_px, const Value& value, const Visit& visit) {
    const int radius = window_px / 2;
    parallel_rows(columns, rows, [&](int first, int end) {
        std::vector<double> column_sum(static_cast<std::size_t>(columns));
        for (int row = first; row < end; ++row) {
            const int bottom = std::max(0, row - radius), top = std::min(rows - 1, row + radius);
            std::fill(column_sum.begin(), column_sum.end(), 0.0);
            for (int source = bottom; source <= top; ++source)
                for (int column = 0; column < columns; ++column)
                    column_sum[static_cast<std::size_t>(column)] += value(column, source);
            double sum = 0;
            for (int column = 0; column < std::min(radius, columns); ++column)
                sum += column_sum[static_cast<std::size_t>(column)];
            for (int column = 0; column < columns; ++column) {
                if (column + radius < columns)
                    sum += column_sum[static_cast<std::size_t>(column + radius)];
                if (column - radius - 1 >= 0)
                    sum -= column_sum[static_cast<std::size_t>(column - radius - 1)];
                visit(column, row, sum / window_pixels(columns, rows, column, row, window_px));
            }
        }
    });
}

double mean(const Grid<float>& image) {
    double sum = 0;
    for (const float value : image.values)
        sum += value;
    return image.values.empty() ? 0 : sum / static_cast<double>(image.values.size());
}

} // namespace

FocusMeasure focus_measure_from_name(std::string_view name) {
    if (name == "standard-deviation")
        return FocusMeasure::standard_deviation;
    if (name == "modified-laplacian")
        return FocusMeasure::modified_laplacian;
    throw InputError({.where = {},
                      .key = "topography.focus_measure",
                      .found = std::string(name),
                      .expected = "\"standard-deviation\" or \"modified-laplacian\"",
                      .remedy = "Name one of the focus measures."});
}

Grid<float> focus_measure(const Grid<float>& image, FocusMeasure measure, int window_px) {
    Grid<float> result(image.columns, image.rows);
    Grid<double> local_mean(image.columns, image.rows);
    // Sums of deviations from the image's mean do not cancel.
    const double centre = mean(image);
    const auto deviation = [&](int column, int row) { return image(column, row) - centre; };
    window_means(image.columns, image.rows, window_px, deviation,
                 [&](int column, int row, double value) { local_mean(column, row) = value; });

    const auto over_mean = [&](int column, int row, double value) {
        const double brightness = centre + local_mean(column, row);
        result(column, row) = brightness > 0 ? static_cast<float>(value / brightness) : 0.0f;
    };
    switch (measure) {
    case FocusMeasure::standard_deviation: {
        const auto squared = [&](int column, int row) {
            const double d = deviation(column, row);
            return d * d;
        };
        window_means(image.columns, image.rows, window_px, squared, [&](int column, int row, double value) {
            const double d = local_mean(column, row);
            over_mean(column, row, std::sqrt(std::max(0.0, value - d * d)));
        });
        break;
    }
    case FocusMeasure::modified_laplacian: {
        const Grid<float> laplacian = modified_laplacian(image);
        window_means(
            image.columns, image.rows, window_px, [&](int column, int row) { return laplacian(column, row); },
            over_mean);
        break;
    }
    }
    return result;
}

Grid<float> window_mean(const Grid<float>& image, int window_px) {
    Grid<float> result(image.columns, image.rows);
    window_means(
        image.columns, image.rows, window_px, [&](int column, int row) { return image(column, row); },
        [&](int column, int row, double value) { result(column, row) = static_cast<float>(value); });
    return result;
}

int window_pixels(int columns, int rows, int column, int row, int window_px) {
    const int radius = window_px / 2;
    const auto extent = [radius](int at, int count) {
        return std::min(count - 1, at + radius) - std::max(0, at - radius) + 1;
    };
    return extent(column, columns) * extent(row, rows);
}

double noise_gain(FocusMeasure measure, int window_pixels) {
    return std::sqrt((measure == FocusMeasure::modified_laplacian ? 12.0 : 1.0) / window_pixels);
}

} // namespace vkfv::topography
