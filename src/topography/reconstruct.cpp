#include "core/error.hpp"
#include "topography/parallel_rows.hpp"
#include "topography/topography.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vkfv::topography {
namespace {

void require(bool good, std::string key, std::string found, std::string expected, std::string remedy) {
    if (!good)
        throw InputError({.where = {},
                          .key = std::move(key),
                          .found = std::move(found),
                          .expected = std::move(expected),
                          .remedy = std::move(remedy)});
}

// The options' ranges are checked before anything is built from them.
const TopographyOptions& checked(const TopographyOptions& options) {
    require(options.window_px >= 3 && options.window_px % 2 == 1, "topography.window_px",
            fmt::format("{}", options.window_px), "an odd number of at least 3",
            "Give the width of the focus window in pixels.");
    require(options.peak == "gaussian", "topography.peak", options.peak, "\"gaussian\"",
            "Leave the key out.");
    require(options.smoothing_steps >= 0 && options.smoothing_steps <= 100, "topography.smoothing_steps",
            fmt::format("{}", options.smoothing_steps), "a number in [0, 100]",
            "Give the average's standard deviation in steps of the scan.");
    require(options.false_peak_rate > 0 && options.false_peak_rate < 1, "topography.false_peak_rate",
            fmt::format("{}", options.false_peak_rate), "a number in (0, 1)",
            "Give the probability with which noise may pass as a height.");
    return options;
}

// Variance of the averaged focus curve over that of the measure of single images. Images averaged with
// weights w have the variance sum w^2 / (sum w)^2 and correlate at a lag by r = sum w w / sum w^2; the
// measure, linear in small noise, correlates alike, and the second average takes the mean over its pairs.
double averaged_variance(const std::vector<double>& one_sided) {
    const int radius = static_cast<int>(one_sided.size()) - 1;
    const auto weight = [&](int d) {
        return std::abs(d) <= radius ? one_sided[static_cast<std::size_t>(std::abs(d))] : 0.0;
    };
    double total = 0;
    for (int d = -radius; d <= radius; ++d)
        total += weight(d);
    const auto overlap = [&](int lag) {
        double sum = 0;
        for (int d = -radius; d <= radius; ++d)
            sum += weight(d) * weight(d + lag);
        return sum / (total * total);
    };
    double variance = 0;
    for (int lag = -2 * radius; lag <= 2 * radius; ++lag)
        variance += overlap(lag) * overlap(lag);
    return variance;
}

} // namespace

double quality_threshold(int images, double false_peak_rate) {
    return std::sqrt(2 * std::max(0.0, std::log(images / (2 * false_peak_rate))));
}

StackEvaluator::StackEvaluator(const TopographyOptions& options)
    : focus_measure_(focus_measure_from_name(checked(options).focus_measure)), window_px_(options.window_px),
      false_peak_rate_(options.false_peak_rate), images_(options.smoothing_steps),
      curves_(options.smoothing_steps) {}

void StackEvaluator::measure(const Grid<float>& averaged_image) {
    curves_.push(focus_measure(averaged_image, focus_measure_, window_px_),
                 [this](const Grid<float>& curve_values) { peaks_.add(curve_values); });
}

void StackEvaluator::observe_noise(const Grid<float>& image) {
    if (latest_.empty())
        brightness_ = squared_differences_ = Grid<float>(image.columns, image.rows);
    parallel_rows(image.columns, image.rows, [&](int first, int end) {
        for (std::size_t k = image.index(0, first); k < image.index(0, end); ++k) {
            brightness_.values[k] += image.values[k];
            if (latest_.size() == 2) {
                const float difference = latest_[0].values[k] - 2 * latest_[1].values[k] + image.values[k];
                squared_differences_.values[k] += difference * difference;
            }
        }
    });
    latest_.push_back(image);
    if (latest_.size() > 2)
        latest_.pop_front();
}

// Standard deviation of a single image's noise over brightness, both over the window and all images.
Grid<float> StackEvaluator::relative_noise() const {
    Grid<float> brightness = window_mean(brightness_, window_px_);
    Grid<float> noise = window_mean(squared_differences_, window_px_);
    const double images = static_cast<double>(z_.size());
    constexpr double gain = 1 + 4 + 1; // of the second difference on the variance of independent values
    for (std::size_t k = 0; k < noise.values.size(); ++k) {
        const double mean = brightness.values[k] / images;
        noise.values[k] =
            mean > 0 ? static_cast<float>(std::sqrt(noise.values[k] / (images - 2) / gain) / mean) : 0.0f;
    }
    return noise;
}

void StackEvaluator::add(const Grid<float>& image, double z) {
    const std::string which = fmt::format("image {}", z_.size());
    require(image.columns > 0 && image.rows > 0, which, "no pixels", "at least one pixel",
            "Check the image.");
    if (!z_.empty()) {
        require(image.columns == columns_ && image.rows == rows_, which,
                fmt::format("{} x {} pixels", image.columns, image.rows),
                fmt::format("{} x {} as the images before", columns_, rows_), "Use images of one size only.");
        require(z > z_.back(), which, fmt::format("z = {} mm after {} mm", z, z_.back()), "ascending z",
                "Order the images by z.");
    }
    if (z_.size() >= 2) {
        constexpr double tolerance = 0.01; // of a step: far below the noise of any height
        const double expected = z_[0] + static_cast<double>(z_.size()) * (z_[1] - z_[0]);
        require(std::abs(z - expected) <= tolerance * (z_[1] - z_[0]), which, fmt::format("z = {} mm", z),
                fmt::format("z = {} mm, equidistant", expected), "Use a stack with one step.");
    }
    require(std::all_of(image.values.begin(), image.values.end(), [](float v) { return std::isfinite(v); }),
            which, "a value that is not finite", "finite values", "Take or trace the image anew.");
    columns_ = image.columns;
    rows_ = image.rows;
    z_.push_back(z);
    observe_noise(image);
    images_.push(image, [this](const Grid<float>& averaged) { measure(averaged); });
}

Topography StackEvaluator::finish(double x0, double y0, double pitch) {
    require(z_.size() >= 3, "stack", fmt::format("{} images", z_.size()), "at least 3 images",
            "A peak needs an image on either side: widen the scan.");
    images_.flush([this](const Grid<float>& averaged) { measure(averaged); });
    curves_.flush([this](const Grid<float>& curve_values) { peaks_.add(curve_values); });

    const int images = static_cast<int>(z_.size());
    const double threshold = quality_threshold(images, false_peak_rate_);
    const double averaging = std::sqrt(averaged_variance(curves_.weights()));
    const Grid<float> noise = relative_noise();
    const double step = (z_.back() - z_.front()) / (images - 1);
    Topography result;
    result.height = {.height = Grid<double>(columns_, rows_, std::numeric_limits<double>::quiet_NaN()),
                     .x0 = x0,
                     .y0 = y0,
                     .pitch_x = pitch,
                     .pitch_y = pitch};
    result.quality = Grid<double>(columns_, rows_);
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column) {
            const int pixels = window_pixels(columns_, rows_, column, row, window_px_);
            const double curve_noise = noise(column, row) * noise_gain(focus_measure_, pixels) * averaging;
            const double quality = peaks_.prominence(column, row) / curve_noise;
            result.quality(column, row) = quality;
            if (quality >= threshold)
                result.height.height(column, row) = z_.front() + step * peaks_.position(column, row);
        }
    return result;
}

Topography reconstruct(std::span<const Grid<float>> stack, std::span<const double> z, double x0, double y0,
                       double pitch, const TopographyOptions& options) {
    if (stack.size() != z.size())
        throw std::invalid_argument("reconstruct: as many heights as images are needed");
    StackEvaluator evaluator(options);
    for (std::size_t k = 0; k < stack.size(); ++k)
        evaluator.add(stack[k], z[k]);
    return evaluator.finish(x0, y0, pitch);
}

} // namespace vkfv::topography
