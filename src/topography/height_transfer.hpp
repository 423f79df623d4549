// The measured over the true amplitude by spatial frequency: the instrument transfer function of ISO 25178-600 for
// small heights.
#pragma once

#include "surface/height_map.hpp"

#include <vector>

namespace vkfv::topography {

// A ring of spatial frequencies, as wide as one over the longer extent.
struct TransferBand {
    double frequency = 0; // middle of the ring, 1/mm
    // Real part of the summed cross-spectrum over the truth's summed power spectrum: 1 where heights pass unchanged;
    // the least-squares factor from true to measured height. A lateral shift lowers it.
    double transfer = 0;
    // Share of the measured power that is linear in the true height, 0 to 1: |cross|^2 over the product of the powers.
    double coherence = 0;
    // Standard error of `transfer`, from the coherence and the number of independent frequencies (Bendat and Piersol
    // 2010, 9.2.4).
    double standard_error = 0;
    double measured_power = 0; // mm^2 mm^2: mean power spectral density
    double true_power = 0;
};

// The transfer between both maps after levelled_pair() without filter, under a Hann window along either axis, from
// twice the window's width up to the Nyquist frequency of the coarser pitch. Points that are not measured count as mean
// height in both, which spreads some power over all frequencies, but of both maps alike. Both maps stand on the same
// grid: std::invalid_argument otherwise. Rings in which either map has no power are left out.
std::vector<TransferBand> height_transfer(const surface::HeightMap& measured, const surface::HeightMap& truth);

} // namespace vkfv::topography
