#include "topography/height_transfer.hpp"

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/units.hpp"
#include "topography/compare.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace vkfv::topography {
namespace {

using Complex = std::complex<double>;

double hann(int k, int n) {
    const double wave = std::sin(pi * (k + 0.5) / n);
    return wave * wave;
}

struct Annulus {
    Complex cross;
    double measured = 0;
    double truth = 0;
    double frequencies = 0;
};

} // namespace

std::vector<TransferBand> height_transfer(const surface::HeightMap& measured, const surface::HeightMap& truth) {
    const LevelledPair pair = levelled_pair(measured, truth);
    const int columns = measured.columns(), rows = measured.rows();
    Grid<Complex> grid(convenient_length(columns), convenient_length(rows));
    double window_power = 0;
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column < columns; ++column) {
            const double window = hann(column, columns) * hann(row, rows);
            if (const double z = pair.measured.height(column, row); std::isfinite(z)) {
                grid(column, row) = window * Complex(z, pair.truth.height(column, row));
                window_power += window * window;
            }
        }
    fourier_transform(grid);

    const double width = 1 / std::max(columns * measured.pitch_x, rows * measured.pitch_y);
    const double nyquist = 0.5 / std::max(measured.pitch_x, measured.pitch_y);
    std::vector<Annulus> annuli(static_cast<std::size_t>(nyquist / width));
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column) {
            const double frequency = std::hypot(fourier_frequency(column, grid.columns) / measured.pitch_x,
                                                fourier_frequency(row, grid.rows) / measured.pitch_y);
            const auto annulus = static_cast<std::size_t>(frequency / width);
            if (annulus >= annuli.size())
                continue;
            // The transform of a + i b, a and b real, is A + i B; at the opposite frequency conj(A) + i conj(B).
            const Complex here = grid(column, row);
            const Complex there =
                std::conj(grid(column == 0 ? 0 : grid.columns - column, row == 0 ? 0 : grid.rows - row));
            const Complex a = (here + there) / 2.0, b = (here - there) / Complex(0, 2);
            annuli[annulus].cross += a * std::conj(b);
            annuli[annulus].measured += std::norm(a);
            annuli[annulus].truth += std::norm(b);
            annuli[annulus].frequencies += 1;
        }

    // The number of independent frequencies: opposite ones are conjugate, and appended zeros and the window, 1.5 lines
    // wide along either axis, add no independent ones.
    const double independent = static_cast<double>(columns) * rows / static_cast<double>(grid.values.size()) / 2 / 2.25;
    const double density = measured.pitch_x * measured.pitch_y / window_power;
    std::vector<TransferBand> bands;
    // The first two annuli are left out, as the window spreads the mean and the remaining tilt over two lines.
    for (std::size_t k = 2; k < annuli.size(); ++k) {
        const Annulus& annulus = annuli[k];
        if (!(annulus.measured > 0 && annulus.truth > 0))
            continue;
        TransferBand band{.frequency = (static_cast<double>(k) + 0.5) * width};
        band.transfer = annulus.cross.real() / annulus.truth;
        band.coherence = std::min(1.0, std::norm(annulus.cross) / (annulus.measured * annulus.truth));
        band.standard_error = std::sqrt(annulus.measured / annulus.truth * (1 - band.coherence) /
                                        (2 * std::max(1.0, annulus.frequencies * independent)));
        band.measured_power = annulus.measured / annulus.frequencies * density;
        band.true_power = annulus.truth / annulus.frequencies * density;
        bands.push_back(band);
    }
    return bands;
}

} // namespace vkfv::topography
