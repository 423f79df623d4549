// The windows of a focus measure over a whole image, in focus::f64::Arithmetic or focus::f32::Arithmetic, which gives a
// device's bits.
#pragma once

#include "core/threads/parallel_rows.hpp"
#include "topography/focus_measure.hpp"

namespace vkfv::topography {

template <class Arithmetic>
struct ImageScene {
    const Channels& image;
    typename Arithmetic::Real image_value(int channel, int column, int row) const {
        return image[static_cast<std::size_t>(channel)](column, row);
    }
};

// The source of the windows for the standard deviation are the channels; for all other measures, their mean and the
// response.
template <class Arithmetic>
struct ChannelSource {
    const Channels& image;
    const std::vector<typename Arithmetic::Real>& weights;
    typename Arithmetic::Real window_weight(int distance) const { return weights[static_cast<std::size_t>(distance)]; }
    typename Arithmetic::Sums window_source(int field, int column, int row) const {
        return {image[static_cast<std::size_t>(field)](column, row), 0};
    }
};

template <class Arithmetic>
struct ResponseSource {
    const Grid<typename Arithmetic::Sums>& pixels;
    const std::vector<typename Arithmetic::Real>& weights;
    typename Arithmetic::Real window_weight(int distance) const { return weights[static_cast<std::size_t>(distance)]; }
    typename Arithmetic::Sums window_source(int, int column, int row) const { return pixels(column, row); }
};

template <class Arithmetic>
struct RowScene {
    const std::vector<Grid<typename Arithmetic::Sums>>& fields;
    const std::vector<typename Arithmetic::Real>& weights;
    typename Arithmetic::Real window_weight(int distance) const { return weights[static_cast<std::size_t>(distance)]; }
    typename Arithmetic::Sums window_row(int field, int column, int row) const {
        return fields[static_cast<std::size_t>(field)](column, row);
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

template <class Arithmetic, class Source>
std::vector<Grid<typename Arithmetic::Sums>> along_rows(const typename Arithmetic::Plan& plan, const Source& source) {
    std::vector<Grid<typename Arithmetic::Sums>> fields;
    for (int field = 0; field < focus_fields(plan); ++field) {
        Grid<typename Arithmetic::Sums>& sums = fields.emplace_back(plan.columns, plan.rows);
        every_pixel(plan.columns, plan.rows, [&](int column, int row) {
            sums(column, row) = window_along_row(source, plan, field, column, row);
        });
    }
    return fields;
}

// The focus measure at every pixel. weights: of the window, as window_weight() gives them.
template <class Arithmetic>
Grid<float> focus_values(const Channels& image, const typename Arithmetic::Plan& plan,
                         const std::vector<typename Arithmetic::Real>& weights) {
    using Sums = typename Arithmetic::Sums;
    std::vector<Grid<Sums>> fields;
    if (focus_responds(plan)) {
        const ImageScene<Arithmetic> scene{image};
        Grid<Sums> responses(plan.columns, plan.rows);
        every_pixel(plan.columns, plan.rows, [&](int column, int row) {
            responses(column, row) = {brightness_at(scene, plan, column, row),
                                      focus_response(scene, plan, column, row)};
        });
        fields = along_rows<Arithmetic>(plan, ResponseSource<Arithmetic>{responses, weights});
    } else {
        fields = along_rows<Arithmetic>(plan, ChannelSource<Arithmetic>{image, weights});
    }
    const RowScene<Arithmetic> rows{fields, weights};
    Grid<float> result(plan.columns, plan.rows);
    every_pixel(plan.columns, plan.rows, [&](int column, int row) {
        result(column, row) = static_cast<float>(focus_value(rows, plan, column, row));
    });
    return result;
}

} // namespace vkfv::topography
