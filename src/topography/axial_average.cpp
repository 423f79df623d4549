#include "topography/axial_average.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace vkfv::topography {

std::vector<double> axial_weights(double standard_deviation) {
    const int radius = static_cast<int>(std::ceil(3 * standard_deviation));
    std::vector<double> weights = {1};
    for (int d = 1; d <= radius; ++d)
        weights.push_back(std::exp(-0.5 * (d / standard_deviation) * (d / standard_deviation)));
    return weights;
}

std::vector<Share> axial_shares(const std::vector<double>& weights, int at, int images) {
    const int radius = static_cast<int>(weights.size()) - 1;
    const int first = std::max(0, at - radius), last = std::min(images - 1, at + radius);
    const auto weight = [&](int image) { return weights[static_cast<std::size_t>(std::abs(image - at))]; };
    double total = 0;
    for (int image = first; image <= last; ++image)
        total += weight(image);
    std::vector<Share> shares;
    for (int image = first; image <= last; ++image)
        shares.push_back({image, static_cast<float>(weight(image) / total)});
    return shares;
}

} // namespace vkfv::topography
