#include "topography/focus_measure.hpp"

#include "topography/focus_windows.hpp"
#include "topography/names.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::topography {
namespace {

namespace f64 = focus::f64;
using f64::Arithmetic;

// A scene for a few pixels: responses and sums along rows are computed when they are read.
struct PixelScene {
    const Channels& image;
    const f64::FocusPlan& plan;
    const std::vector<double>& weights;
    double image_value(int channel, int column, int row) const {
        return image[static_cast<std::size_t>(channel)](column, row);
    }
    double window_weight(int distance) const { return weights[static_cast<std::size_t>(distance)]; }
    f64::WindowSums window_source(int field, int column, int row) const {
        if (plan.measure == f64::FOCUS_STANDARD_DEVIATION) {
            return {image_value(field, column, row), 0};
        }
        return {f64::brightness_at(*this, plan, column, row), f64::focus_response(*this, plan, column, row)};
    }
    f64::WindowSums window_row(int field, int column, int row) const {
        return f64::window_along_row(*this, plan, field, column, row);
    }
};

f64::FocusPlan plan_of(const Channels& image, FocusMeasure measure, const FocusWindow& window) {
    f64::FocusPlan plan{};
    plan.columns = image.front().columns;
    plan.rows = image.front().rows;
    plan.channels = static_cast<int>(image.size());
    plan.measure = static_cast<int>(measure);
    plan.window_radius = window.radius();
    return plan;
}

} // namespace

Grid<float> grey(const Channels& channels) {
    Grid<float> mean(channels.front().columns, channels.front().rows);
    for (const auto& channel : channels) {
        for (std::size_t k = 0; k < mean.values.size(); ++k) {
            mean.values[k] += channel.values[k] / static_cast<float>(channels.size());
        }
    }
    return mean;
}

const std::vector<std::string>& focus_measure_names() {
    static const std::vector<std::string> names = {
        "standard-deviation", "tenengrad", "modified-laplacian", "brenner", "wavelet", "gradient-and-curvature"};
    return names;
}

const std::string& name_of(FocusMeasure measure) {
    return focus_measure_names()[static_cast<std::size_t>(measure)];
}

FocusMeasure focus_measure_from_name(std::string_view name) {
    return static_cast<FocusMeasure>(
        place_of_name(name, focus_measure_names(), "topography.focus_measure", "Name one of the focus measures."));
}

const std::vector<std::string>& window_shape_names() {
    static const std::vector<std::string> names = {"box", "gaussian"};
    return names;
}

const std::string& name_of(WindowShape shape) {
    return window_shape_names()[static_cast<std::size_t>(shape)];
}

WindowShape window_shape_from_name(std::string_view name) {
    return static_cast<WindowShape>(
        place_of_name(name, window_shape_names(), "topography.window_shape", "Name one of the shapes."));
}

FocusWindow::FocusWindow(int width_px, WindowShape shape) {
    for (int d = 0; d <= width_px / 2; ++d)
        weights_.push_back(shape == WindowShape::box ? 1 : std::exp(-0.5 * std::pow(5.0 * d / width_px, 2)));
}

double FocusWindow::pixels(int columns, int rows, int column, int row) const {
    const auto along = [this](int at, int count) {
        double sum = 0, squares = 0;
        for (int k = std::max(0, at - radius()); k <= std::min(count - 1, at + radius()); ++k) {
            const double weight = weights_[static_cast<std::size_t>(std::abs(k - at))];
            sum += weight;
            squares += weight * weight;
        }
        return sum * sum / squares;
    };
    return along(column, columns) * along(row, rows);
}

Grid<float> focus_measure(const Channels& image, FocusMeasure measure, const FocusWindow& window) {
    return focus_values<Arithmetic>(image, plan_of(image, measure, window), window.weights());
}

double focus_at(const Channels& image, FocusMeasure measure, const FocusWindow& window, int column, int row) {
    const f64::FocusPlan plan = plan_of(image, measure, window);
    return f64::focus_value(PixelScene{image, plan, window.weights()}, plan, column, row);
}

Grid<double> focus_responses(const Channels& image, FocusMeasure measure, const FocusWindow& window) {
    const f64::FocusPlan plan = plan_of(image, measure, window);
    Grid<double> responses(plan.columns, plan.rows);
    if (measure == FocusMeasure::standard_deviation) {
        for (const Grid<float>& channel : image) {
            const Grid<float> mean = window_mean(channel, window);
            for (std::size_t k = 0; k < responses.values.size(); ++k) {
                responses.values[k] += f64::squared_deviation(channel.values[k], mean.values[k]);
            }
        }
        return responses;
    }
    const ImageScene<Arithmetic> scene{image};
    every_pixel(plan.columns, plan.rows,
                [&](int column, int row) { responses(column, row) = f64::focus_response(scene, plan, column, row); });
    return responses;
}

Grid<float> window_mean(const Grid<float>& image, const FocusWindow& window) {
    const Channels channels = {image};
    const f64::FocusPlan plan = plan_of(channels, FocusMeasure::standard_deviation, window);
    const auto fields = along_rows<Arithmetic>(plan, ChannelSource<Arithmetic>{channels, window.weights()});
    const RowScene<Arithmetic> rows{fields, window.weights()};
    Grid<float> result(plan.columns, plan.rows);
    every_pixel(plan.columns, plan.rows, [&](int column, int row) {
        result(column, row) = static_cast<float>(f64::window_along_column(rows, plan, 0, column, row).level);
    });
    return result;
}

} // namespace vkfv::topography
