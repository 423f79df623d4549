#include "measurement/fit/stack_statistics.hpp"

#include "core/messages/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace vkfv::measurement {

namespace {
namespace of_stack_statistics { // files of a unity build share the unnamed namespace

constexpr std::array scales = {1, 2, 4};
constexpr int least_pixels = 4;  // of a side, after binning
constexpr int least_squares = 4; // whose focus curves have a distribution
const std::vector<std::string> curve_names = {"mean place / images",
                                              "ln of the scatter of places",
                                              "mean ln of the width",
                                              "scatter of ln width",
                                              "mean ln of the height",
                                              "scatter of ln height",
                                              "mean ln of the lowest over the highest value"};

bool has_scale(const StatisticsLayout& layout, int scale) {
    return std::min(layout.pixels.columns, layout.pixels.rows) / scale >= least_pixels;
}

int squares(const StatisticsLayout& layout) {
    return (layout.pixels.columns / layout.window) * (layout.pixels.rows / layout.window);
}

bool has_curves(const StatisticsLayout& layout) {
    return layout.images >= 3 && squares(layout) >= least_squares;
}

// The logarithm of a relative number, which an image without any contrast does not make infinite.
double logarithm(double value) {
    constexpr double least = 1e-6;
    return std::log(std::max(value, least));
}

Grid<double> binned(const Grid<float>& values, int scale) {
    Grid<double> result(values.columns / scale, values.rows / scale);
    const double area = scale * scale;
    for (int row = 0; row < result.rows * scale; ++row) {
        for (int column = 0; column < result.columns * scale; ++column) {
            result(column / scale, row / scale) += values(column, row) / area;
        }
    }
    return result;
}

// Root mean square of the differences of neighbours along x and y within a rectangle.
double differences(const Grid<double>& values, int column0, int row0, int columns, int rows) {
    double sum = 0;
    int count = 0;
    for (int row = row0; row < row0 + rows; ++row) {
        for (int column = column0; column < column0 + columns; ++column) {
            if (column + 1 < column0 + columns) {
                const double step = values(column + 1, row) - values(column, row);
                sum += step * step;
                ++count;
            }
            if (row + 1 < row0 + rows) {
                const double step = values(column, row + 1) - values(column, row);
                sum += step * step;
                ++count;
            }
        }
    }
    return std::sqrt(sum / std::max(count, 1));
}

struct Moments {
    double mean = 0, deviation = 0;
};

Moments moments_of(const std::vector<double>& values) {
    Moments moments;
    const auto count = static_cast<double>(values.size());
    moments.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    for (const double value : values) {
        moments.deviation += (value - moments.mean) * (value - moments.mean) / count;
    }
    moments.deviation = std::sqrt(moments.deviation);
    return moments;
}

double correlation(const Grid<float>& first, const Grid<float>& second) {
    double a = 0, b = 0, aa = 0, ab = 0, bb = 0;
    const auto count = static_cast<double>(first.values.size());
    for (std::size_t k = 0; k < first.values.size(); ++k) {
        a += first.values[k] / count;
        b += second.values[k] / count;
    }
    for (std::size_t k = 0; k < first.values.size(); ++k) {
        const double x = first.values[k] - a, y = second.values[k] - b;
        aa += x * x;
        ab += x * y;
        bb += y * y;
    }
    return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

// Place (in images), standard deviation and heights of a focus curve. Weights are what squares exceed their smallest
// by, so that noise at the ends of the scan counts little.
struct CurveShape {
    double place = 0, width = 0, highest = 0, lowest = 0;
};

CurveShape shape_of(const std::vector<double>& curve) {
    const auto [lowest, highest] = std::ranges::minmax(curve);
    CurveShape shape{.highest = highest, .lowest = lowest};
    double sum = 0;
    const auto weight = [&](double value) { return value * value - shape.lowest * shape.lowest; };
    for (std::size_t k = 0; k < curve.size(); ++k) {
        sum += weight(curve[k]);
        shape.place += weight(curve[k]) * static_cast<double>(k);
    }
    shape.place = sum > 0 ? shape.place / sum : 0.5 * static_cast<double>(curve.size() - 1);
    for (std::size_t k = 0; k < curve.size(); ++k) {
        const double distance = static_cast<double>(k) - shape.place;
        shape.width += sum > 0 ? weight(curve[k]) * distance * distance / sum : 0;
    }
    shape.width = std::sqrt(shape.width);
    return shape;
}

} // namespace of_stack_statistics
} // namespace

std::vector<StatisticGroup> statistic_groups(const StatisticsLayout& layout) {
    using namespace of_stack_statistics;
    std::vector<StatisticGroup> groups = {
        {.name = "brightness", .title = "brightness over that of the stack", .count = layout.images, .of_images = true},
        {.name = "contrast", .title = "ln of the contrast", .count = layout.images, .of_images = true}};
    groups.reserve(scales.size() + 5);
    for (const int scale : scales) {
        if (has_scale(layout, scale)) {
            groups.push_back({.name = fmt::format("sharpness_{}", scale),
                              .title = scale == 1 ? std::string("ln of the sharpness")
                                                  : fmt::format("ln of the sharpness of {0} x {0} pixels", scale),
                              .count = layout.images,
                              .of_images = true});
        }
    }
    groups.push_back({.name = "likeness",
                      .title = "Fisher's z of the correlation with the next image",
                      .count = layout.images - 1,
                      .of_images = true});
    if (has_curves(layout)) {
        groups.push_back({.name = "curves",
                          .title = "focus curves",
                          .count = static_cast<int>(curve_names.size()),
                          .of_images = false,
                          .names = curve_names});
    }
    if (layout.brightness) {
        groups.push_back({.name = "power",
                          .title = "brightness of the stack",
                          .count = 1,
                          .of_images = false,
                          .names = {"ln of the mean of all images"}});
    }
    return groups;
}

StackStatistics::StackStatistics(const StatisticsLayout& layout)
    : layout_(layout), columns_(layout.pixels.columns / layout.window), rows_(layout.pixels.rows / layout.window) {}

void StackStatistics::add(int image, const Grid<float>& values) {
    using namespace of_stack_statistics;
    if (image == 0) {
        images_.clear();
        likeness_.clear();
        curves_.assign(static_cast<std::size_t>(columns_ * rows_), {});
    }
    const Grid<double> own = binned(values, 1);
    const Moments moments = moments_of(own.values);
    OfImage found{.mean = moments.mean, .deviation = moments.deviation};
    found.differences.reserve(scales.size());
    for (const int scale : scales) {
        if (has_scale(layout_, scale)) {
            const Grid<double> of_scale = binned(values, scale);
            found.differences.push_back(differences(of_scale, 0, 0, of_scale.columns, of_scale.rows));
        }
    }
    if (image > 0) {
        constexpr double most = 0.99999; // images of light have no noise of a camera, and may be equal
        likeness_.push_back(std::atanh(std::clamp(correlation(last_, values), -most, most)));
    }
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            const int side = layout_.window;
            double mean = 0;
            for (int y = row * side; y < (row + 1) * side; ++y) {
                for (int x = column * side; x < (column + 1) * side; ++x) {
                    mean += own(x, y) / (side * side);
                }
            }
            const double sharpness = differences(own, column * side, row * side, side, side);
            curves_[static_cast<std::size_t>(row * columns_ + column)].push_back(mean > 0 ? sharpness / mean : 0);
        }
    }
    images_.push_back(std::move(found));
    last_ = values;
}

std::vector<double> StackStatistics::values() const {
    using namespace of_stack_statistics;
    double power = 0;
    for (const OfImage& image : images_) {
        power += image.mean / static_cast<double>(images_.size());
    }
    if (static_cast<int>(images_.size()) != layout_.images || !(power > 0) || !std::isfinite(power)) {
        throw RunError(
            "the stack has no light, lacks images or has pixels without a value: a fit needs all images, "
            "brighter than 0 in the mean. vkfv verify finds damaged stacks; photographs may need other pages");
    }
    constexpr double least_light = 1e-3; // of the stack's, by which contrasts of dark images are divided
    std::vector<double> values;
    values.reserve(images_.size() * (scales.size() + 3) + curve_names.size() + 1);
    for (const OfImage& image : images_) {
        values.push_back(image.mean / power);
    }
    const auto relative = [&](double value, const OfImage& image) {
        return logarithm(value / std::max(image.mean, least_light * power));
    };
    for (const OfImage& image : images_) {
        values.push_back(relative(image.deviation, image));
    }
    for (std::size_t scale = 0; scale < images_.front().differences.size(); ++scale) {
        for (const OfImage& image : images_) {
            values.push_back(relative(image.differences[scale], image));
        }
    }
    values.insert(values.end(), likeness_.begin(), likeness_.end());
    if (has_curves(layout_)) {
        std::vector<double> places, widths, heights, floors;
        for (auto* of_curves : {&places, &widths, &heights, &floors}) {
            of_curves->reserve(curves_.size());
        }
        for (const auto& curve : curves_) {
            const CurveShape shape = shape_of(curve);
            places.push_back(shape.place);
            widths.push_back(logarithm(shape.width));
            heights.push_back(logarithm(shape.highest));
            floors.push_back(logarithm(shape.highest > 0 ? shape.lowest / shape.highest : 1));
        }
        const Moments place = moments_of(places), width = moments_of(widths), height = moments_of(heights);
        values.insert(values.end(), {place.mean, logarithm(place.deviation), width.mean, width.deviation, height.mean,
                                     height.deviation, moments_of(floors).mean});
    }
    if (layout_.brightness) {
        values.push_back(std::log(power));
    }
    return values;
}

} // namespace vkfv::measurement
