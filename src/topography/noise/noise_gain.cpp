#include "topography/noise/noise_gain.hpp"

#include "core/mathematics/units.hpp"
#include "topography/noise/focus_masks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace vkfv::topography {
namespace {

// The overlap of two masks along one axis: sum over p of a(p) b(p + d), |d| <= 2 mask_reach.
double overlap(const std::array<double, 5>& a, const std::array<double, 5>& b, int d) {
    double sum = 0;
    for (int p = std::max(0, -d); p < std::min(5, 5 - d); ++p) {
        sum += a[static_cast<std::size_t>(p)] * b[static_cast<std::size_t>(p + d)];
    }
    return sum;
}

// The covariance R_ab(k) of two masks' responses (noise_gain.hpp).
double covariance(const Mask& a, const Mask& b, int kx, int ky, const NoiseCorrelation& correlation) {
    constexpr int most = 2 * mask_reach;
    double sum = 0;
    for (int dy = -most; dy <= most; ++dy) {
        const double along_y = overlap(a.y, b.y, dy);
        for (int dx = -most; dx <= most && along_y != 0; ++dx) {
            sum += along_y * overlap(a.x, b.x, dx) * correlation(kx + dx, ky + dy);
        }
    }
    return sum;
}

} // namespace

double noise_gain(FocusMeasure measure, double window_pixels, const NoiseCorrelation& correlation) {
    constexpr int most = 2 * mask_reach + NoiseCorrelation::reach;
    const bool signs = measure == FocusMeasure::modified_laplacian;
    const auto masks = masks_of(measure);
    double sum = 0, energy = 0;
    for (const Mask& a : masks) {
        const double variance_a = covariance(a, a, 0, 0, correlation);
        energy += variance_a;
        for (const Mask& b : masks) {
            const double deviations = std::sqrt(variance_a * covariance(b, b, 0, 0, correlation));
            for (int ky = -most; ky <= most; ++ky) {
                for (int kx = -most; kx <= most; ++kx) {
                    const double here = covariance(a, b, kx, ky, correlation);
                    const double kept = deviations > 0 ? std::clamp(here / deviations, -1.0, 1.0) : 0;
                    sum += here * (signs ? 2 / pi * std::asin(kept) : here);
                }
            }
        }
    }
    // A correlation that no noise can have may leave a response no energy.
    const double variance = signs ? sum : energy > 0 ? sum / energy : 0;
    return std::sqrt(std::max(0.0, variance) / window_pixels);
}

} // namespace vkfv::topography
