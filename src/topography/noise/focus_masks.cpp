#include "topography/noise/focus_masks.hpp"

#include <cmath>

namespace vkfv::topography {

std::vector<Mask> masks_of(FocusMeasure measure) {
    const std::array<double, 5> here = {0, 0, 1, 0, 0}, across = {0, -1, 0, 1, 0};
    const auto both_ways = [](const std::array<double, 5>& one, const std::array<double, 5>& other) {
        return std::vector<Mask>{{one, other}, {other, one}};
    };
    switch (measure) {
    case FocusMeasure::standard_deviation:
        return {{here, here}};
    case FocusMeasure::tenengrad:
        return both_ways(across, {0, 1, 2, 1, 0});
    case FocusMeasure::modified_laplacian:
        return both_ways({0, -1, 2, -1, 0}, here);
    case FocusMeasure::brenner:
        return both_ways(across, here);
    case FocusMeasure::wavelet: {
        std::array<double, 5> low{}, high{};
        for (int tap = -mask_reach; tap <= mask_reach; ++tap) {
            low[static_cast<std::size_t>(tap + mask_reach)] = focus::f64::wavelet_low(tap);
            high[static_cast<std::size_t>(tap + mask_reach)] = focus::f64::wavelet_high(tap);
        }
        auto masks = both_ways(low, high);
        masks.push_back({high, high});
        return masks;
    }
    case FocusMeasure::gradient_and_curvature: {
        const std::array<double, 5> sobel = {0, 1, 2, 1, 0};
        std::array<double, 5> bend = {0, -1, 2, -1, 0};
        for (double& tap : bend) {
            tap *= std::sqrt(0.5);
        }
        auto masks = both_ways(across, sobel);
        for (const Mask& mask : both_ways(bend, sobel)) {
            masks.push_back(mask);
        }
        return masks;
    }
    }
    return {};
}

} // namespace vkfv::topography
