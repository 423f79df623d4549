#include "topography/uncertainty/brightness_pull.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vkfv::topography {
namespace {

constexpr int most_a_side = 128;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Linear between two values; NaN if one of them is (std::lerp() may give the other one).
double mixed(double one, double other, double share) {
    return one + share * (other - one);
}

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

// The mean product of neighbours among the seven blocks in a row or in a column about a block, whichever is larger:
// ridges have errors in common along them, and other ones across. At least 0.
double common_square(const Grid<double>& pulls, int column, int row) {
    constexpr int reach = 3;
    const auto along = [&](int dx, int dy) {
        double sum = 0, pairs = 0;
        for (int k = -reach; k < reach; ++k) {
            const int x = column + k * dx, y = row + k * dy;
            if (x < 0 || y < 0 || x + dx >= pulls.columns || y + dy >= pulls.rows) {
                continue;
            }
            if (const double product = pulls(x, y) * pulls(x + dx, y + dy); std::isfinite(product)) {
                sum += product;
                pairs += 1;
            }
        }
        return pairs > 0 ? sum / pairs : 0;
    };
    return std::max({0.0, along(1, 0), along(0, 1)});
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

std::optional<int> BrightnessOfBlocks::reach_of(double width) const {
    const int reach = std::max(1, static_cast<int>(std::lround(width)));
    return width > 0 && static_cast<int>(images_.size()) >= 2 * reach + 2 ? std::optional(reach) : std::nullopt;
}

template <class AtImage>
double BrightnessOfBlocks::between_images(double height, const AtImage& at_image) const {
    if (!(height >= 0 && height <= static_cast<double>(images_.size() - 1))) {
        return unknown;
    }
    const auto below = std::min(static_cast<std::size_t>(height), images_.size() - 2);
    return mixed(at_image(below), at_image(below + 1), height - static_cast<double>(below));
}

BrightnessPull BrightnessOfBlocks::pull(const Grid<double>& height, double width, double step) const {
    const auto reach = reach_of(width);
    if (!reach) {
        return {};
    }
    Grid<double> pulls = means_of(height, side_, sums_.columns, sums_.rows);
    const auto of_blocks = slopes_of_blocks(*reach);
    for (std::size_t block = 0; block < pulls.values.size(); ++block) {
        pulls.values[block] = width * width * between_images(pulls.values[block], [&](std::size_t image) {
                                  return static_cast<double>(of_blocks[image][block]);
                              });
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
