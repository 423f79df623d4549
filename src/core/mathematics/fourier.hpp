// The discrete Fourier transform of a grid, through Eigen's FFT.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/mathematics/line_transform.hpp"

#include <complex>
#include <vector>

namespace vkfv {

// Transforms in place: F[l, m] = sum over i, k of f[i, k] exp(-2 pi i (i l / columns + k m / rows)), without a factor.
// Indices above half the size are negative frequencies. Any size is allowed; convenient_length() is the fastest.
void fourier_transform(Grid<std::complex<double>>& grid);

// The inverse of fourier_transform(), with the factor 1 / (columns rows).
void inverse_fourier_transform(Grid<std::complex<double>>& grid);

// The type II cosine transform in place, which is the Fourier transform of the grid continued by reflection at its
// edges: C[l, m] = sum over i, k of f[i, k] cos(pi l (2 i + 1) / (2 columns)) cos(pi m (2 k + 1) / (2 rows)); value l
// belongs to l / (2 columns) cycles per point. It uses one Fourier transform of the same length (J. Makhoul, "A fast
// cosine transform in one and two dimensions", 1980).
void cosine_transform(Grid<double>& grid);

// The inverse of cosine_transform().
void inverse_cosine_transform(Grid<double>& grid);

// Convolves in place with a separable symmetric weighting: the sum over i, k of f[x - i, y - k] along_x[|i|]
// along_y[|k|], with f zero beyond its borders. The weights go from the middle outwards, at most as far as the grid is
// long. It uses transforms of padded lines, whose time hardly depends on the number of weights.
void convolve(Grid<std::complex<double>>& grid, const std::vector<double>& along_x, const std::vector<double>& along_y);

// The frequency of index k in a transform of n values, in cycles per value: k / n, minus 1 from n / 2 on.
inline double fourier_frequency(int k, int n) {
    return static_cast<double>(2 * k < n ? k : k - n) / n;
}

} // namespace vkfv
