// White noise that was blurred before pixels gathered it, by its power spectrum.
#pragma once

#include "core/mathematics/fourier.hpp"
#include "core/mathematics/grid.hpp"
#include "core/mathematics/units.hpp"
#include "topography/noise/noise_gain.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <random>

namespace vkfv::topography::test {

// Images of side x side pixels, periodic, of variance 1 and mean 0.
class BlurredNoise {
  public:
    // spectrum(fx, fy): power in cycles per mm before pixels of this pitch (mm) gather it, 0 beyond the cutoff.
    template <class Spectrum>
    BlurredNoise(int side, double pitch, double cutoff, const Spectrum& spectrum) : power_(side, side) {
        const auto through_pixel = [&](double f) {
            const double x = pi * f * pitch;
            return x == 0 ? 1 : std::pow(std::sin(x) / x, 2);
        };
        const int folds = static_cast<int>(std::ceil(cutoff * pitch));
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                double& here = power_(column, row);
                for (int ky = -folds; ky <= folds; ++ky) {
                    for (int kx = -folds; kx <= folds; ++kx) {
                        const double fx = (fourier_frequency(column, side) + kx) / pitch;
                        const double fy = (fourier_frequency(row, side) + ky) / pitch;
                        if (std::hypot(fx, fy) < cutoff) {
                            here += spectrum(fx, fy) * through_pixel(fx) * through_pixel(fy);
                        }
                    }
                }
            }
        }
        const double sum = std::accumulate(power_.values.begin(), power_.values.end(), 0.0);
        for (double& value : power_.values) {
            value *= static_cast<double>(power_.values.size()) / sum;
        }
    }
    // Noise of independent pixels.
    explicit BlurredNoise(int side) : power_(side, side, 1.0) {}

    // The correlation of neighbouring pixels: the transform of the power, cut off at the reach.
    NoiseCorrelation correlation() const {
        Grid<std::complex<double>> transform(power_.columns, power_.rows);
        std::ranges::copy(power_.values, transform.values.begin());
        inverse_fourier_transform(transform);
        NoiseCorrelation result;
        for (int dy = 0; dy <= NoiseCorrelation::reach; ++dy) {
            for (int dx = -NoiseCorrelation::reach; dx <= NoiseCorrelation::reach; ++dx) {
                result.set(dx, dy, transform((dx + power_.columns) % power_.columns, dy).real());
            }
        }
        return result;
    }

    Grid<double> image(std::mt19937_64& random) const {
        std::normal_distribution<double> normal;
        Grid<std::complex<double>> field(power_.columns, power_.rows);
        for (auto& value : field.values) {
            value = normal(random);
        }
        fourier_transform(field);
        for (std::size_t k = 0; k < field.values.size(); ++k) {
            field.values[k] *= std::sqrt(power_.values[k]);
        }
        inverse_fourier_transform(field);
        Grid<double> result(power_.columns, power_.rows);
        std::ranges::transform(field.values, result.values.begin(), [](const auto& value) { return value.real(); });
        return result;
    }

  private:
    Grid<double> power_;
};

// Hopkins' transfer function of an ideal pupil in focus, s = f / cutoff.
inline double in_focus(double s) {
    return s < 1 ? 2 / pi * (std::acos(s) - s * std::sqrt(1 - s * s)) : 0;
}

// Noise of light that an ideal pupil of this aperture blurs as a whole, at a wavelength of 0.55 um (pitch in mm).
inline BlurredNoise blurred_by_pupil(int side, double aperture, double pitch) {
    const double cutoff = 2 * aperture / 0.55e-3;
    return {side, pitch, cutoff,
            [=](double fx, double fy) { return std::pow(in_focus(std::hypot(fx, fy) / cutoff), 2); }};
}

// Noise of light of which every part of the pupil blurs its own, with the weight that the overlap of the displaced
// pupils leaves it: 0 or 1. Wavelength and units are those of blurred_by_pupil().
inline BlurredNoise blurred_by_parts(int side, double aperture, double pitch) {
    const double cutoff = 2 * aperture / 0.55e-3;
    return {side, pitch, cutoff, [=](double fx, double fy) { return in_focus(std::hypot(fx, fy) / cutoff); }};
}

} // namespace vkfv::topography::test
