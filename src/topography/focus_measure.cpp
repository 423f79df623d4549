#include "topography/focus_measure.hpp"

#include "core/parallel_rows.hpp"
#include "topography/names.hpp"

#include <algorithm>
#include <cmath>

namespace vkfv::topography {
namespace {

namespace f64 = focus::f64;

struct ImageScene {
    const Channels& image;
    double image_value(int channel, int column, int row) const {
        return image[static_cast<std::size_t>(channel)](column, row);
    }
};

// The standard deviation gathers the channels; all other measures their mean and the response.
struct ChannelSource {
    const Channels& image;
    const std::vector<double>& weights;
    double window_weight(int distance) const { return weights[static_cast<std::size_t>(distance)]; }
    f64::WindowSums window_source(int field, int column, int row) const {
        return {image[static_cast<std::size_t>(field)](column, row), 0};
    }
};

struct ResponseSource {
    const Grid<f64::WindowSums>& pixels;
    const std::vector<double>& weights;
    double window_weight(int distance) const { return weights[static_cast<std::size_t>(distance)]; }
    f64::WindowSums window_source(int, int column, int row) const { return pixels(column, row); }
};

struct RowScene {
    const std::vector<Grid<f64::WindowSums>>& fields;
    const std::vector<double>& weights;
    double window_weight(int distance) const { return weights[static_cast<std::size_t>(distance)]; }
    f64::WindowSums window_row(int field, int column, int row) const {
        return fields[static_cast<std::size_t>(field)](column, row);
    }
};

// Both at once, computed where they are asked for: of few pixels.
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

// Calls task(column, row) for every pixel.
template <class Task>
void every_pixel(int columns, int rows, const Task& task) {
    parallel_rows(columns, rows, [&](int first, int end) {
        for (int row = first; row < end; ++row)
            for (int column = 0; column < columns; ++column)
                task(column, row);
    });
}

template <class Source>
std::vector<Grid<f64::WindowSums>> along_rows(const f64::FocusPlan& plan, const Source& source) {
    std::vector<Grid<f64::WindowSums>> fields;
    for (int field = 0; field < f64::focus_fields(plan); ++field) {
        Grid<f64::WindowSums>& sums = fields.emplace_back(plan.columns, plan.rows);
        every_pixel(plan.columns, plan.rows, [&](int column, int row) {
            sums(column, row) = f64::window_along_row(source, plan, field, column, row);
        });
    }
    return fields;
}

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
    static const std::vector<std::string> names = {"standard-deviation", "tenengrad", "modified-laplacian", "brenner",
                                                   "wavelet"};
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
    const f64::FocusPlan plan = plan_of(image, measure, window);
    std::vector<Grid<f64::WindowSums>> fields;
    if (measure == FocusMeasure::standard_deviation) {
        fields = along_rows(plan, ChannelSource{image, window.weights()});
    } else {
        const ImageScene scene{image};
        Grid<f64::WindowSums> responses(plan.columns, plan.rows);
        every_pixel(plan.columns, plan.rows, [&](int column, int row) {
            responses(column, row) = {f64::brightness_at(scene, plan, column, row),
                                      f64::focus_response(scene, plan, column, row)};
        });
        fields = along_rows(plan, ResponseSource{responses, window.weights()});
    }
    const RowScene rows{fields, window.weights()};
    Grid<float> result(plan.columns, plan.rows);
    every_pixel(plan.columns, plan.rows, [&](int column, int row) {
        result(column, row) = static_cast<float>(f64::focus_value(rows, plan, column, row));
    });
    return result;
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
    const ImageScene scene{image};
    every_pixel(plan.columns, plan.rows,
                [&](int column, int row) { responses(column, row) = f64::focus_response(scene, plan, column, row); });
    return responses;
}

Grid<float> window_mean(const Grid<float>& image, const FocusWindow& window) {
    const Channels channels = {image};
    const f64::FocusPlan plan = plan_of(channels, FocusMeasure::standard_deviation, window);
    const auto fields = along_rows(plan, ChannelSource{channels, window.weights()});
    const RowScene rows{fields, window.weights()};
    Grid<float> result(plan.columns, plan.rows);
    every_pixel(plan.columns, plan.rows, [&](int column, int row) {
        result(column, row) = static_cast<float>(f64::window_along_column(rows, plan, 0, column, row).level);
    });
    return result;
}

} // namespace vkfv::topography
