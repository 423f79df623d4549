#include "surface/robust_filter.hpp"

#include "surface/filter.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vkfv::surface {
namespace {

// The median of |map - low| over the measured points; 0 if there are none.
double median_residual(const HeightMap& map, const HeightMap& low) {
    std::vector<double> residuals;
    for (std::size_t k = 0; k < map.height.values.size(); ++k) {
        if (const double r = map.height.values[k] - low.height.values[k]; std::isfinite(r)) {
            residuals.push_back(std::abs(r));
        }
    }
    if (residuals.empty()) {
        return 0;
    }
    const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
    std::ranges::nth_element(residuals, middle);
    return *middle;
}

} // namespace

HeightMap robust_gaussian_low_pass(const HeightMap& map, double nesting_index) {
    constexpr double reach = 4.4478, settled = 1e-4;
    constexpr int most_rounds = 50;
    HeightMap low = gaussian_low_pass(map, nesting_index);
    Grid<double> weights(map.columns(), map.rows());
    double last = 0;
    for (int round = 0; round < most_rounds; ++round) {
        const double c = reach * median_residual(map, low);
        if (!(c > 0) || std::abs(c - last) < settled * c) {
            break;
        }
        last = c;
        for (std::size_t k = 0; k < weights.values.size(); ++k) {
            const double share = (map.height.values[k] - low.height.values[k]) / c;
            weights.values[k] = std::abs(share) < 1 ? std::pow(1 - share * share, 2) : 0;
        }
        const HeightMap next = weighted_low_pass(map, weights, nesting_index);
        for (std::size_t k = 0; k < weights.values.size(); ++k) {
            if (std::isfinite(next.height.values[k])) {
                low.height.values[k] = next.height.values[k];
            }
        }
    }
    return low;
}

} // namespace vkfv::surface
