#include "report/frames.hpp"

#include "core/threads/parallel_rows.hpp"
#include "report/png.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vkfv::report {

namespace {

constexpr int most_frames = 200;
constexpr double most_frame_pixels = 6e6; // sum over all frames
constexpr int most_frame_side = 512;
constexpr double brightest_share = 1e-3; // share of pixels that is clipped

template <class Value>
Grid<Value> means_of_blocks(const Grid<Value>& image, int block) {
    if (block == 1) {
        return image;
    }
    Grid<Value> result((image.columns + block - 1) / block, (image.rows + block - 1) / block);
    parallel_rows(image.columns, result.rows, [&](int first, int end) {
        std::vector<double> sums(static_cast<std::size_t>(result.columns));
        std::vector<int> counts(sums.size());
        for (int row = first; row < end; ++row) {
            std::ranges::fill(sums, 0.0);
            std::ranges::fill(counts, 0);
            for (int y = row * block; y < std::min(image.rows, (row + 1) * block); ++y) {
                const Value* pixel = &image.values[image.index(0, y)];
                for (int x = 0, column = 0; x < image.columns; ++column) {
                    for (const int block_end = std::min(image.columns, x + block); x < block_end; ++x) {
                        const bool finite = std::isfinite(pixel[x]);
                        sums[static_cast<std::size_t>(column)] += finite ? static_cast<double>(pixel[x]) : 0.0;
                        counts[static_cast<std::size_t>(column)] += finite ? 1 : 0;
                    }
                }
            }
            for (int column = 0; column < result.columns; ++column) {
                const auto k = static_cast<std::size_t>(column);
                result(column, row) =
                    counts[k] > 0 ? static_cast<Value>(sums[k] / counts[k]) : std::numeric_limits<Value>::quiet_NaN();
            }
        }
    });
    return result;
}

// The value that only the brightest share of pixels exceeds, found from a sample of the pixels.
float white_of(const std::vector<Grid<float>>& frames) {
    constexpr std::size_t most_values = 200000;
    std::size_t pixels = 0;
    for (const auto& frame : frames) {
        pixels += frame.values.size();
    }
    const std::size_t stride = std::max<std::size_t>(1, pixels / most_values) | 1; // odd: no column is preferred
    std::vector<float> values;
    std::size_t at = 0;
    for (const auto& frame : frames) {
        for (; at < frame.values.size(); at += stride) {
            values.push_back(frame.values[at]);
        }
        at -= frame.values.size();
    }
    if (values.empty()) {
        return 0;
    }
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>((1 - brightest_share) * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, place);
    return *place > 0 ? *place : *std::ranges::max_element(values);
}

} // namespace

Grid<float> block_means(const Grid<float>& image, int block) {
    return means_of_blocks(image, block);
}

Grid<double> block_means(const Grid<double>& image, int block) {
    return means_of_blocks(image, block);
}

int block_for(int columns, int rows, double most, int most_a_side) {
    int block = 1;
    const auto left = [&block](int pixels) { return (pixels + block - 1) / block; };
    while (std::max(left(columns), left(rows)) > std::max(1, most_a_side) ||
           (static_cast<double>(left(columns)) * left(rows) > most && (left(columns) > 1 || left(rows) > 1))) {
        ++block;
    }
    return block;
}

void FrameTally::add(const Grid<float>& image, double z) {
    if (taken_ == 0) {
        frames_.every = (std::max(1, images_) + most_frames - 1) / most_frames;
        const int frames = (images_ + frames_.every - 1) / frames_.every;
        frames_.block = block_for(image.columns, image.rows, most_frame_pixels / std::max(1, frames), most_frame_side);
    }
    if (taken_++ % frames_.every == 0) {
        kept_.push_back(block_means(image, frames_.block));
        frames_.z.push_back(z);
    }
}

Frames FrameTally::finish() {
    if (kept_.empty()) {
        return std::move(frames_);
    }
    frames_.columns = kept_.front().columns;
    frames_.rows = kept_.front().rows;
    frames_.white = white_of(kept_);
    frames_.pngs.resize(kept_.size());
    const float scale = frames_.white > 0 ? 255 / frames_.white : 0;
    parallel_bands(static_cast<int>(kept_.size()), 1, [&](int first, int end) {
        for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(end); ++k) {
            Grid<std::uint8_t> bytes(frames_.columns, frames_.rows);
            std::ranges::transform(kept_[k].values, bytes.values.begin(), [&](float value) {
                return static_cast<std::uint8_t>(std::lround(std::clamp(value * scale, 0.0f, 255.0f)));
            });
            frames_.pngs[k] = grey_png_bytes(bytes);
        }
    });
    kept_.clear();
    return std::move(frames_);
}

} // namespace vkfv::report
