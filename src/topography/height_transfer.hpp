// How much of the truth's height passes into a measurement, by spatial frequency: the instrument transfer function of
// ISO 25178-600 for small heights.
#pragma once

#include "surface/height_map.hpp"

#include <vector>

namespace vkfv::topography {

// A ring of spatial frequencies, one over the longer extent wide.
struct TransferBand {
    double frequency = 0; // of the ring's middle, 1/mm
    // Real part of the summed cross-spectrum over the truth's summed power spectrum: 1 where heights pass as they are,
    // the least-squares factor from true to measured height. A lateral shift lowers it.
    double transfer = 0;
    // Share of the measured power that is linear in the true one, 0 to 1: |cross|^2 over the product of the powers.
    double coherence = 0;
    // Of `transfer`, from the coherence and the number of independent frequencies (Bendat and Piersol 2010, 9.2.4).
    double standard_error = 0;
    double measured_power = 0; // mm^2 mm^2: mean power spectral density
    double true_power = 0;
};

// Of both maps after levelled_pair() without filter, under a Hann window along either axis, up to the Nyquist frequency
// of the coarser pitch; from twice the window's width up. Not-measured points count as mean height in both, which
// spreads some power over all frequencies, but of both maps alike. Both maps stand on the same grid:
// std::invalid_argument otherwise. Rings without power of either map are left out.
std::vector<TransferBand> height_transfer(const surface::HeightMap& measured, const surface::HeightMap& truth);

} // namespace vkfv::topography
