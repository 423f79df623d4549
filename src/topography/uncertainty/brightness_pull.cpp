#include "topography/uncertainty/brightness_pull.hpp"

#include "core/threads/parallel_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vkfv::topography {
namespace {

constexpr int most_a_side = 128;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// The mean of the finite values of every block, NaN where there is none.
Grid<double> means_of(const Grid<double>& map, int side, int columns, int rows) {
    Grid<double> sums(columns, rows), counts(columns, rows);
    for (int row = 0; row < map.rows; ++row) {
        for (int column = 0; column < map.columns; ++column) {
            if (const double value = map(column, row); std::isfinite(value)) {
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

std::vector<std::vector<float>> BrightnessOfBlocks::slopes_of_blocks(int reach) const {
    const auto images = static_cast<int>(images_.size());
    const std::size_t blocks = sums_.values.size();
    std::vector<std::vector<float>> logarithms;
    for (std::size_t image = 0; image < images_.size(); ++image) {
        std::vector<float>& of_image = logarithms.emplace_back(blocks, std::numeric_limits<float>::quiet_NaN());
        for (std::size_t block = 0; block < blocks; ++block) {
            const double here = static_cast<double>(images_[image][block]);
            if (here > 0 && whole_[image] > 0) {
                of_image[block] = static_cast<float>(std::log(here / whole_[image]));
            }
        }
    }
    std::vector<std::vector<float>> result(images_.size(),
                                           std::vector<float>(blocks, std::numeric_limits<float>::quiet_NaN()));
    for (int at = reach; at + reach < images; ++at) {
        std::vector<float>& slopes = result[static_cast<std::size_t>(at)];
        std::ranges::fill(slopes, 0.0f);
        float squares = 0;
        for (int d = -reach; d <= reach; ++d) {
            const auto weight = static_cast<float>(d);
            squares += weight * weight;
            for (std::size_t block = 0; block < blocks; ++block) {
                slopes[block] += weight * logarithms[static_cast<std::size_t>(at + d)][block];
            }
        }
        for (float& slope : slopes) {
            slope /= squares;
        }
    }
    return result;
}

Grid<double> BrightnessOfBlocks::slopes(const Grid<double>& height, double width) const {
    Grid<double> result(height.columns, height.rows, unknown);
    const auto images = static_cast<int>(images_.size());
    const int reach = std::max(1, static_cast<int>(std::lround(width)));
    if (!(width > 0) || images < 2 * reach + 2) {
        return result;
    }
    const auto of_blocks = slopes_of_blocks(reach);
    // The two blocks whose middles lie around a pixel, and the share of the second.
    struct Between {
        int first, second;
        double share;
    };
    const auto between = [&](int pixel, int blocks) {
        const double place = (pixel + 0.5) / side_ - 0.5;
        const int first = std::clamp(static_cast<int>(std::floor(place)), 0, blocks - 1);
        return Between{
            .first = first, .second = std::min(first + 1, blocks - 1), .share = std::clamp(place - first, 0.0, 1.0)};
    };
    parallel_rows(height.columns, height.rows, [&](int from, int end) {
        for (int row = from; row < end; ++row) {
            const Between y = between(row, sums_.rows);
            for (int column = 0; column < height.columns; ++column) {
                const double at = height(column, row);
                if (!(at >= 0 && at <= images - 1)) {
                    continue;
                }
                const Between x = between(column, sums_.columns);
                const auto below = std::min(static_cast<std::size_t>(at), images_.size() - 2);
                const auto of_image = [&](std::size_t image) {
                    const std::vector<float>& slopes = of_blocks[image];
                    const auto along = [&](int block_row) {
                        return std::lerp(static_cast<double>(slopes[sums_.index(x.first, block_row)]),
                                         static_cast<double>(slopes[sums_.index(x.second, block_row)]), x.share);
                    };
                    return std::lerp(along(y.first), along(y.second), y.share);
                };
                result(column, row) = std::lerp(of_image(below), of_image(below + 1), at - static_cast<double>(below));
            }
        }
    });
    return result;
}

BrightnessPull BrightnessOfBlocks::pull(const Grid<double>& slopes, double width, double step) const {
    Grid<double> pulls = means_of(slopes, side_, sums_.columns, sums_.rows);
    for (double& pull : pulls.values) {
        pull *= width * width;
    }
    BrightnessPull result{.side = side_, .blocks = Grid<double>(pulls.columns, pulls.rows)};
    for (int row = 0; row < pulls.rows; ++row) {
        for (int column = 0; column < pulls.columns; ++column) {
            result.blocks(column, row) = step * std::sqrt(common_square(pulls, column, row));
        }
    }
    return result;
}

} // namespace vkfv::topography
