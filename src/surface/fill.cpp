#include "surface/fill.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace vkfv::surface {
namespace {

// The number of smoothing sweeps: a gap of n points needs some n sweeps to its middle, and larger ones are smooth
// already from their coarse heights.
constexpr int sweeps = 200;
constexpr double over_relaxation = 1.5;

// Halves a grid by means over 2 x 2 points, of the measured ones among them.
Grid<double> halved(const Grid<double>& fine) {
    Grid<double> coarse((fine.columns + 1) / 2, (fine.rows + 1) / 2);
    for (int row = 0; row < coarse.rows; ++row)
        for (int column = 0; column < coarse.columns; ++column) {
            double sum = 0, count = 0;
            for (int j = 2 * row; j < std::min(2 * row + 2, fine.rows); ++j)
                for (int i = 2 * column; i < std::min(2 * column + 2, fine.columns); ++i)
                    if (std::isfinite(fine(i, j))) {
                        sum += fine(i, j);
                        count += 1;
                    }
            coarse(column, row) = count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
        }
    return coarse;
}

bool has_gaps(const Grid<double>& grid) {
    return std::ranges::any_of(grid.values, [](double value) { return !std::isfinite(value); });
}

// The value of the half-size grid at a point of the fine grid, bilinear.
double between(const Grid<double>& coarse, int column, int row) {
    const double u = std::clamp((column - 0.5) / 2, 0.0, coarse.columns - 1.0);
    const double v = std::clamp((row - 0.5) / 2, 0.0, coarse.rows - 1.0);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const int right = std::min(i + 1, coarse.columns - 1), above = std::min(j + 1, coarse.rows - 1);
    return std::lerp(std::lerp(coarse(i, j), coarse(right, j), u - i),
                     std::lerp(coarse(i, above), coarse(right, above), u - i), v - j);
}

void fill_from_coarse(Grid<double>& grid) {
    if (!has_gaps(grid))
        return;
    Grid<double> coarse = halved(grid);
    fill_from_coarse(coarse);
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column)
            if (double& value = grid(column, row); !std::isfinite(value))
                value = between(coarse, column, row);
}

} // namespace

HeightMap fill_not_measured(HeightMap map) {
    std::vector<std::pair<int, int>> gaps;
    for (int row = 0; row < map.rows(); ++row)
        for (int column = 0; column < map.columns(); ++column)
            if (!std::isfinite(map.height(column, row)))
                gaps.emplace_back(column, row);
    if (gaps.empty() || gaps.size() == map.height.values.size())
        return map;
    fill_from_coarse(map.height);
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (const auto& [column, row] : gaps) {
            double sum = 0, count = 0;
            for (const auto& [i, j] :
                 {std::pair{column - 1, row}, {column + 1, row}, {column, row - 1}, {column, row + 1}})
                if (i >= 0 && j >= 0 && i < map.columns() && j < map.rows()) {
                    sum += map.height(i, j);
                    count += 1;
                }
            double& height = map.height(column, row);
            height += over_relaxation * (sum / count - height);
        }
    return map;
}

} // namespace vkfv::surface
