#include "topography/topography.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vkfv::topography {
namespace {

constexpr std::size_t least_neighbours = 5; // a majority, so that the median is between measured heights
constexpr double normal_mad = 1.4826;       // standard deviation over median absolute deviation, of normal values
constexpr double outlying = 6;              // robust standard deviations

// The middle value, or the lower of the middle two for an even number, so that it is one of the heights.
template <class Iterator>
double median(Iterator begin, Iterator end) {
    const auto middle = begin + (end - begin - 1) / 2;
    std::nth_element(begin, middle, end);
    return *middle;
}

double median_of_neighbours(const Grid<double>& height, int column, int row) {
    std::array<double, 8> values{};
    std::size_t count = 0;
    for (int j = std::max(0, row - 1); j <= std::min(height.rows - 1, row + 1); ++j)
        for (int i = std::max(0, column - 1); i <= std::min(height.columns - 1, column + 1); ++i)
            if ((i != column || j != row) && std::isfinite(height(i, j)))
                values[count++] = height(i, j);
    if (count < least_neighbours || !std::isfinite(height(column, row)))
        return std::numeric_limits<double>::quiet_NaN();
    return median(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count));
}

} // namespace

void repair_outliers(Topography& topography) {
    Grid<double>& height = topography.height.height;
    Grid<double> medians(height.columns, height.rows);
    std::vector<double> distances;
    for (int row = 0; row < height.rows; ++row)
        for (int column = 0; column < height.columns; ++column) {
            medians(column, row) = median_of_neighbours(height, column, row);
            if (std::isfinite(medians(column, row)))
                distances.push_back(std::abs(height(column, row) - medians(column, row)));
        }
    if (distances.empty())
        return;
    const double limit = outlying * normal_mad * median(distances.begin(), distances.end());
    for (std::size_t k = 0; k < height.values.size(); ++k)
        if (std::abs(height.values[k] - medians.values[k]) > limit) {
            height.values[k] = medians.values[k];
            topography.state.values[k] = PointState::repaired;
        }
}

} // namespace vkfv::topography
