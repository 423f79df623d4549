#include "topography/stack_faults.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vkfv::topography {
namespace {

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

// Means over so many pixels a side; the remainder at the end is not used.
Grid<float> binned(const Channels& image, int side) {
    Grid<float> result(image[0].columns / side, image[0].rows / side);
    const auto share = static_cast<float>(1.0 / (static_cast<double>(image.size()) * side * side));
    for (const Grid<float>& channel : image) {
        for (int row = 0; row < result.rows * side; ++row) {
            for (int column = 0; column < result.columns * side; ++column) {
                result(column / side, row / side) += share * channel(column, row);
            }
        }
    }
    return result;
}

// Pearson's correlation of the reference with the image as it is seen through the transform, over the points of both.
double correlation_through(const Grid<float>& reference, const Grid<float>& image, const ImageTransform& transform) {
    const Grid<float> moved = resampled({image}, transform).front();
    const int beside_x = static_cast<int>(std::ceil(std::abs(transform.shift_x))),
              beside_y = static_cast<int>(std::ceil(std::abs(transform.shift_y)));
    double count = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (int row = beside_y; row < reference.rows - beside_y; ++row) {
        for (int column = beside_x; column < reference.columns - beside_x; ++column) {
            const double here = reference(column, row), there = moved(column, row);
            count += 1;
            a += here;
            b += there;
            aa += here * here;
            bb += there * there;
            ab += here * there;
        }
    }
    const double variances = (aa - a * a / count) * (bb - b * b / count);
    return count > 0 && variances > 0 ? (ab - a * b / count) / std::sqrt(variances) : 0;
}

// The movement between two images; none if it does not make them more alike. Where images have no texture in common, as
// where compression left blocks of few patterns, phase correlation finds some large shift all the same.
MeasuredTransform movement_between(const Grid<float>& before, const Grid<float>& here) {
    constexpr double small = 1;        // bins; not worth a doubt
    constexpr double least_gain = 0.3; // share of what the images do not have in common
    MeasuredTransform found = measured_transform(before, here);
    const auto& [shift_x, shift_y, scale] = found.transform;
    const double corner =
        std::hypot(shift_x, shift_y) + std::abs(scale - 1) * 0.5 * std::hypot(here.columns, here.rows);
    const bool alike = corner < small || 1 - correlation_through(before, here, found.transform) <
                                             (1 - least_gain) * (1 - correlation_through(before, here, {}));
    return alike ? found : MeasuredTransform{};
}

} // namespace

void find_faults_of_light(const std::vector<double>& brightness, StackFaults& faults) {
    const auto count = static_cast<int>(brightness.size());
    if (count < 3) {
        return;
    }
    std::vector<double> seconds;
    for (std::size_t k = 2; k < brightness.size(); ++k) {
        seconds.push_back(std::abs(brightness[k - 2] - 2 * brightness[k - 1] + brightness[k]));
    }
    // The median of the magnitudes is scaled as for normal values, so that a single step does not enlarge it. Second
    // differences of independent values have six times their variance.
    constexpr double median_of_normal = 0.6745;
    faults.flicker = median(seconds) / (median_of_normal * std::sqrt(6.0));
    constexpr int side = 3; // images
    constexpr double least_step = 0.01, least_deviations = 6, least_at_once = 0.7;
    for (int k = side; k + side <= count; ++k) {
        const auto at = brightness.begin() + k;
        const double step = (std::accumulate(at, at + side, 0.0) - std::accumulate(at - side, at, 0.0)) / side;
        const double at_once = (*at - *(at - 1)) / step;
        if (std::abs(step) > std::max(least_step, least_deviations * faults.flicker) && at_once > least_at_once &&
            std::abs(step) > std::abs(faults.exposure_step)) {
            faults.exposure_step = step;
            faults.step_image = k;
        }
    }
}

void StackFaultsFinder::add(const Channels& image) {
    constexpr int most_a_side = 256, most_movements = 20;
    const int place = static_cast<int>(brightness_.size());
    double sum = 0;
    for (const Grid<float>& channel : image) {
        sum = std::accumulate(channel.values.begin(), channel.values.end(), sum);
        saturation_.add(channel.values);
    }
    brightness_.push_back(sum);
    if (place == 0) {
        columns_ = image[0].columns;
        rows_ = image[0].rows;
        pixels_a_bin_ = std::ceil(std::max(columns_, rows_) / static_cast<double>(most_a_side));
    }
    const int every = (images_ + most_movements - 1) / most_movements;
    constexpr int least_bins = 32; // a quarter of a side can be followed
    if (place % every != 0 || image[0].columns != columns_ || image[0].rows != rows_ ||
        std::min(columns_, rows_) < least_bins * pixels_a_bin_) {
        return;
    }
    Grid<float> here = binned(image, static_cast<int>(pixels_a_bin_));
    if (!before_.values.empty()) {
        movements_.push_back(std::async(
            std::launch::async, [before = std::move(before_), here] { return movement_between(before, here); }));
    }
    before_ = std::move(here);
}

StackFaults StackFaultsFinder::finish() {
    StackFaults faults{.saturated_share = saturation_.found().share};
    const double mean = std::accumulate(brightness_.begin(), brightness_.end(), 0.0) /
                        static_cast<double>(std::max<std::size_t>(1, brightness_.size()));
    if (mean > 0) {
        for (double& value : brightness_) {
            value /= mean;
        }
        find_faults_of_light(brightness_, faults);
    }
    // The place of each compared image in the frame of the first, with the sums of the variances.
    struct Place {
        ImageTransform transform{};
        double shift_variance = 0;
        double scale_variance = 0;
    };
    std::vector<Place> places(1);
    for (auto& movement : movements_) {
        const MeasuredTransform step = movement.get();
        const Place& before = places.back();
        places.push_back({.transform = before.transform.then(step.transform),
                          .shift_variance = before.shift_variance + step.shift_deviation * step.shift_deviation,
                          .scale_variance = before.scale_variance + step.scale_deviation * step.scale_deviation});
    }
    constexpr double least_deviations = 5;
    for (std::size_t later = 1; later < places.size(); ++later) {
        for (std::size_t earlier = 0; earlier < later; ++earlier) {
            const Place &from = places[earlier], &to = places[later];
            const double wander = pixels_a_bin_ * std::hypot(to.transform.shift_x - from.transform.shift_x,
                                                             to.transform.shift_y - from.transform.shift_y);
            const double deviation = pixels_a_bin_ * std::sqrt(to.shift_variance - from.shift_variance);
            if (wander > std::max(faults.wander, least_deviations * deviation)) {
                faults.wander = wander;
            }
            const double change = to.transform.scale / from.transform.scale;
            const double scale_deviation = std::sqrt(to.scale_variance - from.scale_variance);
            if (std::abs(change - 1) > std::max(std::abs(faults.scale - 1), least_deviations * scale_deviation)) {
                faults.scale = change;
            }
        }
    }
    faults.corner_wander = std::abs(faults.scale - 1) * 0.5 * std::hypot(columns_, rows_);
    return faults;
}

} // namespace vkfv::topography
