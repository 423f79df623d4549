// The factor by which a focus measure passes the images' noise.
#pragma once

#include "topography/focus_measure.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace vkfv::topography {

// Autocorrelation r of the noise of an image's pixels, in pixels along x and y: r(0, 0) = 1, r(-k) = r(k), 0 beyond the
// reach. Any blur of an image after its noise arose (pupil filter, Airy pattern, demosaicing) correlates neighbours.
class NoiseCorrelation {
  public:
    static constexpr int reach = 4;

    NoiseCorrelation() { set(0, 0, 1); } // independent pixels

    double operator()(int dx, int dy) const {
        const bool inside = dx >= -reach && dx <= reach && dy >= -reach && dy <= reach;
        return inside ? values_[index(dx, dy)] : 0;
    }
    // True if any neighbouring pixels are correlated.
    bool neighbours() const {
        return std::ranges::count_if(values_, [](double value) { return value != 0; }) > 1;
    }
    // Sets the correlation at (dx, dy) and (-dx, -dy), within the reach.
    void set(int dx, int dy, double value) { values_[index(dx, dy)] = values_[index(-dx, -dy)] = value; }

  private:
    static constexpr int side = 2 * reach + 1;
    static std::size_t index(int dx, int dy) { return static_cast<std::size_t>((dy + reach) * side + dx + reach); }

    std::array<double, static_cast<std::size_t>(side) * side> values_{};
};

// Standard deviation of the measure over a window of n pixels, for image noise of relative standard deviation 1 in
// every pixel and of this correlation, beside stronger texture of the same spectrum: white light on the specimen that
// is blurred as the noise is. Noise passes linearly for small values. Narrow windows average less of the noise that
// correlates between pixels, and have up to a fifth less.
//
// With the measure's masks a, b, ... (which respond with the energy sum over a of (a * image)^2) and the covariance
//   R_ab(k) = sum over p, q of a(p) b(q) r(k + q - p)
// of two masks' responses to the noise at places k apart, the gain is sqrt(V / n) with
//   V = sum over a, b, k of R_ab(k)^2 / sum over a of R_aa(0),
// by frequencies sqrt(<e^2 S^2> / <e S> / n) with the masks' energy e and the noise's spectrum S. For independent
// pixels V is 1 (standard deviation), 130/3 (Tenengrad), 5 (Brenner), 269165/36096 (wavelet),
// 419/5 (gradient and curvature: its magnitudes have a thirteenth of V less, and 0.44 V without texture). Without
// texture the noise is 1 / sqrt(2) of that.
//
// The modified Laplacian adds magnitudes, and texture keeps the signs of its two masks' responses:
//   V = sum over a, b, k of (2/pi) asin(R_ab(k) / sqrt(R_aa(0) R_bb(0))) R_ab(k),
// 27.9 for independent pixels. Without texture their absolute values have the covariances
// (2/pi)(sqrt(1 - c^2) + c asin c - 1) of the correlation c, which add up to 12.02 / n.
//
// Noise less blurred than the texture (waves: the cells of the pupil are blurred each for itself) has up to a tenth
// more by standard deviation and Tenengrad, a thirtieth less by the wavelet.
double noise_gain(FocusMeasure measure, double window_pixels, const NoiseCorrelation& correlation = {});

} // namespace vkfv::topography
