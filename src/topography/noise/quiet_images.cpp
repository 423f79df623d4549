#include "topography/noise/quiet_images.hpp"

#include <algorithm>
#include <cstddef>

namespace vkfv::topography {

double smallest_quarter(std::vector<double> values) {
    const auto quarter = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
    std::ranges::nth_element(values, quarter);
    return *quarter;
}

std::vector<int> quiet_images(const std::vector<double>& variances, bool all) {
    constexpr int apart = 3;
    constexpr double most = 3; // multiple of the smallest quarter's limit, which noise hardly reaches
    const int count = static_cast<int>(variances.size());
    const auto at = [&](int k) { return variances[static_cast<std::size_t>(k)]; };
    std::vector<double> around;
    for (int k = 0; k < count; ++k) {
        const int before = k >= apart ? k - apart : k + apart, after = k + apart < count ? k + apart : k - apart;
        around.push_back(at(std::clamp(before, 0, count - 1)) + at(std::clamp(after, 0, count - 1)));
    }
    std::vector<int> images;
    const double quiet = smallest_quarter(around), limit = most * smallest_quarter(variances);
    for (int k = 0; k < count; ++k) {
        if (all || (around[static_cast<std::size_t>(k)] <= quiet && at(k) <= limit)) {
            images.push_back(k + 1);
        }
    }
    return images;
}

} // namespace vkfv::topography
