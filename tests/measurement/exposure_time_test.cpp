// The brightest light of an image sets the exposure, though its rays are few.
#include "measurement/image/camera_images.hpp"

#include <gtest/gtest.h>

#include <random>

namespace vkfv::measurement {
namespace {

// A field of 1 with a half of 3, and normal noise of this standard deviation.
Grid<double> half_bright(double noise) {
    std::mt19937 random(4);
    std::normal_distribution<double> normal(0, 1);
    Grid<double> flux(64, 64);
    for (int row = 0; row < flux.rows; ++row) {
        for (int column = 0; column < flux.columns; ++column) {
            flux(column, row) = (column < 32 ? 1 : 3) + noise * normal(random);
        }
    }
    return flux;
}

TEST(BrightestFlux, IsThatOfTheBrightPartWhateverTheNoise) {
    EXPECT_DOUBLE_EQ(brightest_flux(half_bright(0), Grid<double>(64, 64)), 3);
    // Squares of 16 pixels leave 0.5 / 16 of noise; the brightest of eight lies at most 3 of it above the mean.
    EXPECT_NEAR(brightest_flux(half_bright(0.5), Grid<double>(64, 64, 0.5)), 3, 3 * 0.5 / 16);
    // Pixel by pixel the noise would be taken for light.
    EXPECT_GT(brightest_flux(half_bright(0.5), Grid<double>(64, 64)), 4);
}

TEST(BrightestFlux, LeavesOutOnePixelOfAThousand) {
    Grid<double> flux(64, 64, 1);
    flux(3, 5) = flux(40, 20) = flux(60, 60) = 50; // less than a thousandth of 4096
    EXPECT_DOUBLE_EQ(brightest_flux(flux, Grid<double>(64, 64)), 1);
    for (int column = 0; column < 8; ++column) {
        flux(column, 9) = 50;
    }
    EXPECT_DOUBLE_EQ(brightest_flux(flux, Grid<double>(64, 64)), 50);
}

} // namespace
} // namespace vkfv::measurement
