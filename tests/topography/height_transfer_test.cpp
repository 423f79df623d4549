#include "topography/height_transfer.hpp"

#include "support/statistics.hpp"
#include "topography/waves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vkfv::topography {
namespace {

using namespace test;
using surface::HeightMap;

constexpr double pitch = 0.002;
constexpr int columns = 180, rows = 150;
constexpr double highest = 0.4 / pitch;

double all(double) {
    return 1;
}

// A Gaussian low-pass that halves heights at the cut-off wavelength.
auto gaussian(double cut_off) {
    return [=](double frequency) { return std::exp(-std::log(2.0) * std::pow(cut_off * frequency, 2)); };
}

TEST(HeightTransfer, OfAGaussianLowPassIsThatLowPass) {
    const double cut_off = 8 * pitch;
    const auto waves = random_waves(400, 0, highest, 1e-3, 3);
    const auto bands = height_transfer(map_of(waves, columns, rows, pitch, 0, 0, gaussian(cut_off)),
                                       map_of(waves, columns, rows, pitch, 0, 0, all));
    ASSERT_GT(bands.size(), 80u);
    int compared = 0;
    for (const TransferBand& band : bands)
        if (band.frequency < 0.95 * highest) {
            // The power of the waves within two lines of the ring tells of the transfer there: its slope is at most
            // 1.01 cut_off (at 0.85 / cut_off), over two lines and a half of 1 / 0.36 mm.
            EXPECT_NEAR(band.transfer, gaussian(cut_off)(band.frequency), 1.01 * cut_off * 2.5 / 0.36)
                << band.frequency;
            ++compared;
        }
    EXPECT_GT(compared, 60);
    // On the average over the bands such errors cancel, to a part of a line: a cut-off 10 % longer is told apart.
    double right = 0, wrong = 0;
    for (const TransferBand& band : bands)
        if (band.frequency < 0.95 * highest) {
            right += (band.transfer - gaussian(cut_off)(band.frequency)) / compared;
            wrong += (band.transfer - gaussian(1.1 * cut_off)(band.frequency)) / compared;
        }
    EXPECT_LT(std::abs(right), 0.01);
    EXPECT_GT(std::abs(wrong), 0.02);
}

TEST(HeightTransfer, ErrsAsItSaysUnderNoise) {
    const double sigma = 4e-3;
    const auto waves = random_waves(400, 0, highest, 1e-3, 3);
    const HeightMap truth = map_of(waves, columns, rows, pitch, 0, 0, all);
    HeightMap measured = map_of(waves, columns, rows, pitch, 0, 0, [](double) { return 0.7; });
    std::mt19937_64 random(9);
    std::normal_distribution<double> normal(0, sigma);
    for (double& z : measured.height.values)
        z += normal(random);
    double right = 0, wrong = 0, counted = 0, noise_power = 0;
    for (const TransferBand& band : height_transfer(measured, truth)) {
        if (band.frequency < 0.9 * highest) {
            right += std::pow((band.transfer - 0.7) / band.standard_error, 2);
            wrong += std::pow((band.transfer - 0.75) / band.standard_error, 2);
            counted += 1;
            // gamma^2 = 1 - noise / measured power: what is left of the measured power is the noise's.
            noise_power += (1 - band.coherence) * band.measured_power;
        }
    }
    ASSERT_GT(counted, 60);
    // The sum is of squared standard normal values; neighbouring rings share a window's width, so half as many are
    // independent.
    EXPECT_GT(vkfv::test::chi_square_tail(right / 2, counted / 2), 1e-3);
    EXPECT_LT(vkfv::test::chi_square_tail(right / 2, counted / 2), 1 - 1e-3);
    EXPECT_LT(vkfv::test::chi_square_tail(wrong / 2, counted / 2), 1e-3);
    // The noise's density is sigma^2 a pitch squared, the fit of one factor a ring taking part of the innermost.
    EXPECT_NEAR(noise_power / counted, sigma * sigma * pitch * pitch, 0.05 * sigma * sigma * pitch * pitch);
}

TEST(HeightTransfer, LosesToALateralShift) {
    // Waves run along x alone, 12 lines apart so that no window mixes them: cos(2 pi f shift) of each is left.
    const double line = 1 / (columns * pitch), shift = 1.5 * pitch;
    std::vector<Wave> waves;
    for (int k = 1; k <= 6; ++k)
        waves.push_back({1e-3, (12 * k + 0.5) * line, 0, 0.3 * k});
    const auto bands = height_transfer(map_of(waves, columns, rows, pitch, shift, 0, all),
                                       map_of(waves, columns, rows, pitch, 0, 0, all));
    for (const Wave& wave : waves) {
        const auto band = std::find_if(bands.begin(), bands.end(), [&](const TransferBand& candidate) {
            return std::abs(candidate.frequency - wave.frequency_x) < 0.1 * line;
        });
        ASSERT_NE(band, bands.end());
        // The window's parts of opposite phase do not matter so far from frequency zero; the least-squares tilts of
        // the two maps differ by less than 1 / (pi 12)^2 of a wave.
        EXPECT_NEAR(band->transfer, std::cos(2 * pi * wave.frequency_x * shift), 0.01);
        EXPECT_LE(band->coherence, 1);
    }
}

} // namespace
} // namespace vkfv::topography
