// The discrete Fourier transform of a grid, through Eigen's FFT.
#pragma once

#include "core/mathematics/grid.hpp"

#include <complex>
#include <vector>

namespace vkfv {

// In place: F[l, m] = sum over i, k of f[i, k] exp(-2 pi i (i l / columns + k m / rows)), without a factor.
// Frequencies above half the size are the negative ones. Any size; quick for those of convenient_length().
void fourier_transform(Grid<std::complex<double>>& grid);

// Its inverse: the factor 1 / (columns rows) is here.
void inverse_fourier_transform(Grid<std::complex<double>>& grid);

// The type II cosine transform, the Fourier transform of the grid continued by mirroring it about its edges: in place,
// C[l, m] = sum over i, k of f[i, k] cos(pi l (2 i + 1) / (2 columns)) cos(pi m (2 k + 1) / (2 rows)); value l belongs
// to l / (2 columns) cycles per point. By one Fourier transform of the same length (J. Makhoul, "A fast cosine
// transform in one and two dimensions", 1980).
void cosine_transform(Grid<double>& grid);

// Its inverse.
void inverse_cosine_transform(Grid<double>& grid);

// In place: the sum over i, k of f[x - i, y - k] along_x[|i|] along_y[|k|], f zero beyond its borders: what a separable
// symmetric weighting gives, of weights from the middle outwards, none further out than the grid is long. By transforms
// of padded lines, in time that hardly depends on how many weights there are.
void convolve(Grid<std::complex<double>>& grid, const std::vector<double>& along_x, const std::vector<double>& along_y);

// The smallest number from `least` on with no prime factor above 5.
int convenient_length(int least);

// Of index k in a transform of n values, in cycles per value: k / n, less 1 from n / 2 on.
inline double fourier_frequency(int k, int n) {
    return static_cast<double>(2 * k < n ? k : k - n) / n;
}

} // namespace vkfv
