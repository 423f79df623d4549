#include "topography/noise/image_halves.hpp"

namespace vkfv::topography {
namespace {

std::vector<Share> every_second(const std::vector<Share>& shares, int parity) {
    std::vector<Share> half;
    float total = 0;
    for (const Share& share : shares) {
        if (share.image % 2 == parity) {
            half.push_back(share);
            total += share.weight;
        }
    }
    for (Share& share : half) {
        share.weight /= total;
    }
    return half;
}

} // namespace

std::vector<Halves> halves_at(const std::vector<double>& axial_weights, int at, int images) {
    std::vector<Halves> result;
    if (axial_weights.size() > 1) {
        const auto shares = axial_shares(axial_weights, at, images);
        result.push_back({.one = every_second(shares, 0), .other = every_second(shares, 1)});
        return result;
    }
    for (const int first : {at - 1, at}) {
        if (first >= 0 && first + 1 < images) {
            result.push_back({.one = {{first, 1.0f}}, .other = {{first + 1, 1.0f}}});
        }
    }
    return result;
}

} // namespace vkfv::topography
