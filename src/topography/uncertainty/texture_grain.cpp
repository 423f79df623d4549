#include "topography/uncertainty/texture_grain.hpp"

#include "core/threads/parallel_list.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <vector>

namespace vkfv::topography {
namespace {

constexpr int most_side = 512, most_reach = 16;

Channels middle_of(const Channels& image) {
    const int columns = std::min(most_side, image.front().columns), rows = std::min(most_side, image.front().rows);
    const int left = (image.front().columns - columns) / 2, below = (image.front().rows - rows) / 2;
    Channels result;
    for (const Grid<float>& channel : image) {
        Grid<float>& part = result.emplace_back(columns, rows);
        for (int row = 0; row < rows; ++row) {
            for (int column = 0; column < columns; ++column) {
                part(column, row) = channel(left + column, below + row);
            }
        }
    }
    return result;
}

} // namespace

Grid<double> grain_correlation(const Channels& all_in_focus, FocusMeasure measure, const FocusWindow& window) {
    const int reach = std::min(most_reach, 2 * window.radius()), side = 2 * reach + 1;
    Grid<double> result(side, side);
    result(reach, reach) = 1;
    if (all_in_focus.empty()) {
        return result;
    }
    const Grid<double> responses = focus_responses(middle_of(all_in_focus), measure, window);
    Grid<float> strength(responses.columns, responses.rows);
    std::ranges::transform(responses.values, strength.values.begin(),
                           [](double value) { return static_cast<float>(value); });
    const Grid<float> around = window_mean(strength, FocusWindow(6 * window.radius() + 3, WindowShape::box));
    Grid<double> grains(responses.columns, responses.rows);
    for (std::size_t k = 0; k < grains.values.size(); ++k) {
        grains.values[k] = around.values[k] > 0 ? responses.values[k] / static_cast<double>(around.values[k]) - 1 : 0;
    }
    // The correlation is even, so that half of the plane suffices.
    const auto along = parallel_list(reach + 1, [&](int dy) {
        std::vector<double> sums;
        for (int dx = -reach; dx <= reach; ++dx) {
            double sum = 0;
            for (int row = 0; row + dy < grains.rows; ++row) {
                for (int column = std::max(0, -dx); column < std::min(grains.columns, grains.columns - dx); ++column) {
                    sum += grains(column, row) * grains(column + dx, row + dy);
                }
            }
            const double pairs =
                std::max(0, grains.rows - dy) * static_cast<double>(std::max(0, grains.columns - std::abs(dx)));
            sums.push_back(pairs > 0 ? sum / pairs : 0);
        }
        return sums;
    });
    const double variance = along[0][static_cast<std::size_t>(reach)];
    if (variance > 0) {
        for (int dy = 0; dy <= reach; ++dy) {
            for (int dx = -reach; dx <= reach; ++dx) {
                const double here =
                    along[static_cast<std::size_t>(dy)][static_cast<std::size_t>(dx + reach)] / variance;
                result(reach + dx, reach + dy) = result(reach - dx, reach - dy) = here;
            }
        }
    }
    return result;
}

} // namespace vkfv::topography
