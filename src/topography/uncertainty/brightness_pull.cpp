#include "topography/uncertainty/brightness_pull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vkfv::topography {
namespace {

constexpr int most_a_side = 128;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Mean height of every block, NaN where there is none.
Grid<double> means_of(const Grid<double>& height, int side, int columns, int rows) {
    Grid<double> sums(columns, rows), counts(columns, rows);
    for (int row = 0; row < height.rows; ++row) {
        for (int column = 0; column < height.columns; ++column) {
            if (const double value = height(column, row); std::isfinite(value)) {
                sums(column / side, row / side) += value;
                counts(column / side, row / side) += 1;
            }
        }
    }
    for (std::size_t k = 0; k < sums.values.size(); ++k) {
        sums.values[k] = counts.values[k] > 0 ? sums.values[k] / counts.values[k] : unknown;
    }
    return sums;
}

// The mean product of the pairs of neighbours, along x and along y, among a block and the eight around it.
double common_square(const Grid<double>& pulls, int column, int row) {
    double sum = 0, pairs = 0;
    const auto add = [&](double one, double other) {
        if (std::isfinite(one * other)) {
            sum += one * other;
            pairs += 1;
        }
    };
    const int left = std::max(0, column - 1), right = std::min(pulls.columns - 1, column + 1);
    const int lower = std::max(0, row - 1), upper = std::min(pulls.rows - 1, row + 1);
    for (int y = lower; y <= upper; ++y) {
        for (int x = left; x <= right; ++x) {
            if (x < right) {
                add(pulls(x, y), pulls(x + 1, y));
            }
            if (y < upper) {
                add(pulls(x, y), pulls(x, y + 1));
            }
        }
    }
    return pairs > 0 ? std::max(0.0, sum / pairs) : 0;
}

} // namespace

double BrightnessPull::at(int column, int row) const {
    return blocks.values.empty() ? 0 : blocks(column / side, row / side);
}

BrightnessOfBlocks::BrightnessOfBlocks(int columns, int rows, int window_px)
    : columns_(columns), rows_(rows),
      side_(std::max({window_px, (columns + most_a_side - 1) / most_a_side, (rows + most_a_side - 1) / most_a_side})),
      sums_((columns + side_ - 1) / side_, (rows + side_ - 1) / side_) {}

void BrightnessOfBlocks::add(const Channels& image) {
    std::ranges::fill(sums_.values, 0.0);
    for (const Grid<float>& channel : image) {
        for (int row = 0; row < rows_; ++row) {
            for (int block = 0; block < sums_.columns; ++block) {
                const auto first =
                    channel.values.begin() + static_cast<std::ptrdiff_t>(channel.index(block * side_, row));
                sums_(block, row / side_) +=
                    std::accumulate(first, first + std::min(side_, columns_ - block * side_), 0.0f);
            }
        }
    }
    const double total = std::accumulate(sums_.values.begin(), sums_.values.end(), 0.0);
    whole_.push_back(total / (static_cast<double>(columns_) * rows_));
    auto& means = images_.emplace_back(sums_.values.size());
    for (int row = 0; row < sums_.rows; ++row) {
        for (int block = 0; block < sums_.columns; ++block) {
            const double pixels =
                static_cast<double>(std::min(side_, columns_ - block * side_)) * std::min(side_, rows_ - row * side_);
            means[sums_.index(block, row)] = static_cast<float>(sums_(block, row) / pixels);
        }
    }
}

double BrightnessOfBlocks::slope(std::size_t block, double height, double width) const {
    const int images = static_cast<int>(images_.size());
    const int reach = std::max(1, static_cast<int>(std::lround(width)));
    if (!std::isfinite(height)) {
        return unknown;
    }
    const int at = static_cast<int>(std::lround(height));
    if (at - reach < 0 || at + reach >= images) {
        return unknown;
    }
    double product = 0, squares = 0;
    for (int d = -reach; d <= reach; ++d) {
        const auto image = static_cast<std::size_t>(at + d);
        const double here = static_cast<double>(images_[image][block]), whole = whole_[image];
        if (!(here > 0) || !(whole > 0)) {
            return unknown;
        }
        product += d * std::log(here / whole);
        squares += d * d;
    }
    return product / squares;
}

BrightnessPull BrightnessOfBlocks::pull(const Grid<double>& height, double width, double step) const {
    BrightnessPull result{.side = side_, .blocks = {}};
    if (!(width > 0)) {
        return result;
    }
    Grid<double> pulls = means_of(height, side_, sums_.columns, sums_.rows);
    for (std::size_t block = 0; block < pulls.values.size(); ++block) {
        pulls.values[block] = width * width * slope(block, pulls.values[block], width);
    }
    result.blocks = Grid<double>(pulls.columns, pulls.rows);
    for (int row = 0; row < pulls.rows; ++row) {
        for (int column = 0; column < pulls.columns; ++column) {
            result.blocks(column, row) = step * std::sqrt(common_square(pulls, column, row));
        }
    }
    return result;
}

} // namespace vkfv::topography
