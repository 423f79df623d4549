#include "measurement/evaluation/frame_correction.hpp"

#include "core/messages/error.hpp"
#include "scan/image_series.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

namespace vkfv::measurement {

namespace {

using Channels = std::vector<Grid<float>>;

bool same_size(const Channels& a, const Channels& b) {
    return a.size() == b.size() && a.front().columns == b.front().columns && a.front().rows == b.front().rows;
}

std::string size_of(const Channels& image) {
    return fmt::format("{} x {} pixels, channels: {}", image.front().columns, image.front().rows, image.size());
}

[[noreturn]] void refuse_size(const std::filesystem::path& file, const Channels& found, const Channels& expected) {
    refuse_file(file, "", size_of(found), size_of(expected) + ", as the images it is used with have",
                "Take it by the same camera and settings as the stack.");
}

// The mean of all images of a file or folder.
Channels mean_of(const std::filesystem::path& path) {
    const scan::ImageSeries series(path);
    Channels first = series.read(0);
    std::vector<std::vector<double>> sums;
    for (const auto& channel : first) {
        sums.emplace_back(channel.values.begin(), channel.values.end());
    }
    for (int image = 1; image < series.size(); ++image) {
        const Channels next = series.read(image);
        if (!same_size(next, first)) {
            refuse_size(path, next, first);
        }
        for (std::size_t channel = 0; channel < sums.size(); ++channel) {
            std::ranges::transform(sums[channel], next[channel].values, sums[channel].begin(), std::plus<>());
        }
    }
    for (std::size_t channel = 0; channel < sums.size(); ++channel) {
        std::ranges::transform(sums[channel], first[channel].values.begin(),
                               [&](double sum) { return static_cast<float>(sum / series.size()); });
    }
    return first;
}

float median_of(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

// The largest value that an unlit pixel may have in a dark image. The median of the distances from the median tells the
// spread of noise and pixel offsets, since a few lit pixels do not move it: 1.4826 times this median is the standard
// deviation of a normal distribution, of which 16 million pixels reach 5.5 standard deviations. A limit of more than
// twice that leaves room for offsets that spread wider than a normal distribution. Four steps of whole numbers leave
// room in dark images whose values are nearly all equal.
float most_of_dark(const Grid<float>& dark) {
    const float median = median_of(dark.values);
    std::vector<float> distances;
    std::ranges::transform(dark.values, std::back_inserter(distances),
                           [median](float value) { return std::abs(value - median); });
    constexpr float standard_deviations = 12, of_median_distance = 1.4826F, steps = 4;
    const auto whole = [](float value) { return value == std::round(value); };
    const float least = std::ranges::all_of(dark.values, whole) ? steps : 0;
    return median + std::max(standard_deviations * of_median_distance * median_of(std::move(distances)), least);
}

} // namespace

FrameCorrection::FrameCorrection(const CorrectionFiles& files) {
    if (files.dark) {
        file_ = *files.dark;
        dark_ = mean_of(*files.dark);
        is_dead_.resize(dark_.front().values.size(), false);
        for (const auto& channel : dark_) {
            const float most = most_of_dark(channel);
            for (std::size_t k = 0; k < is_dead_.size(); ++k) {
                is_dead_[k] = is_dead_[k] || !(channel.values[k] <= most);
            }
        }
    }
    if (files.flat_field) {
        file_ = *files.flat_field;
        gain_ = mean_of(*files.flat_field);
        if (!dark_.empty() && !same_size(gain_, dark_)) {
            refuse_size(*files.flat_field, gain_, dark_);
        }
        is_dead_.resize(gain_.front().values.size(), false);
        for (std::size_t channel = 0; channel < gain_.size(); ++channel) {
            auto& values = gain_[channel].values;
            if (!dark_.empty()) {
                std::ranges::transform(values, dark_[channel].values, values.begin(), std::minus<>());
            }
            const float median = median_of(values);
            constexpr float least_share = 0.02F; // of the median; lenses leave more at a corner
            if (!(median > 0)) {
                refuse_file(*files.flat_field, "", fmt::format("a median of {:g} above the dark image", median),
                            "more light than that",
                            "Give an image of an even, lit surface, and the dark one as --dark.");
            }
            double sum = 0;
            std::size_t count = 0;
            for (std::size_t k = 0; k < values.size(); ++k) {
                is_dead_[k] = is_dead_[k] || !(values[k] >= least_share * median);
                sum += is_dead_[k] ? 0 : values[k];
                count += is_dead_[k] ? 0 : 1;
            }
            const auto mean = static_cast<float>(sum / static_cast<double>(std::max<std::size_t>(count, 1)));
            std::ranges::transform(values, values.begin(), [mean](float value) { return mean / value; });
        }
    }
    for (std::size_t k = 0; k < is_dead_.size(); ++k) {
        if (is_dead_[k]) {
            dead_.push_back(k);
        }
    }
    constexpr double most_dead = 0.05;
    if (static_cast<double>(dead_.size()) > most_dead * static_cast<double>(is_dead_.size())) {
        refuse_file(file_, "", fmt::format("{} dead pixels of {}", dead_.size(), is_dead_.size()),
                    "one of twenty at most", "Take the dark image without any light, and the flat field evenly lit.");
    }
}

std::vector<Grid<float>> FrameCorrection::corrected(std::vector<Grid<float>> image,
                                                    const std::filesystem::path& name) const {
    const auto& known = gain_.empty() ? dark_ : gain_;
    if (known.empty()) {
        return image;
    }
    if (!same_size(image, known)) {
        refuse_size(name, image, known);
    }
    for (std::size_t channel = 0; channel < image.size(); ++channel) {
        auto& grid = image[channel];
        if (!dark_.empty()) {
            std::ranges::transform(grid.values, dark_[channel].values, grid.values.begin(), std::minus<>());
        }
        if (!gain_.empty()) {
            std::ranges::transform(grid.values, gain_[channel].values, grid.values.begin(), std::multiplies<>());
        }
        for (const std::size_t place : dead_) {
            const int column = static_cast<int>(place % static_cast<std::size_t>(grid.columns));
            const int row = static_cast<int>(place / static_cast<std::size_t>(grid.columns));
            // The value is the mean of the nearest ring of pixels that has a pixel which is not dead.
            float sum = 0;
            int count = 0;
            for (int reach = 1; count == 0 && reach < std::max(grid.columns, grid.rows); ++reach) {
                for (int y = std::max(0, row - reach); y <= std::min(grid.rows - 1, row + reach); ++y) {
                    for (int x = std::max(0, column - reach); x <= std::min(grid.columns - 1, column + reach); ++x) {
                        if (!is_dead_[grid.index(x, y)]) {
                            sum += grid(x, y);
                            ++count;
                        }
                    }
                }
            }
            grid.values[place] = count > 0 ? sum / static_cast<float>(count) : 0;
        }
    }
    return image;
}

} // namespace vkfv::measurement
