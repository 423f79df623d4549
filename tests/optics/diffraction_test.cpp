#include "optics/waves/diffraction.hpp"

#include "core/mathematics/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

using namespace vkfv;
using optics::Diffraction;

namespace {

constexpr double aperture = 0.28, wavelength = 0.587562e-3; // mm

optics::AiryPattern pattern() {
    return {aperture, optics::Spectrum::line(wavelength * um_per_mm)};
}

Grid<float> point(int size, int column, int row) {
    Grid<float> image(size, size);
    image(column, row) = 1;
    return image;
}

double sum(const Grid<float>& image) {
    return std::accumulate(image.values.begin(), image.values.end(), 0.0);
}

// The share of the Airy pattern's light within a radius (Rayleigh, 1881): 1 - J0^2 - J1^2 of v = 2 pi NA r /
// wavelength.
double encircled(double radius) {
    const double v = 2 * pi * aperture * radius / wavelength;
    return 1 - std::pow(std::cyl_bessel_j(0, v), 2) - std::pow(std::cyl_bessel_j(1, v), 2);
}

// In pixels so fine, whose share of a circle's rim is that of their middles, the pattern is Rayleigh's: the rim of
// radius r crosses about 8 r / p pixels, whose halves err independently, by at most half a pixel's light each.
TEST(Diffraction, EncircledEnergyIsRayleighs) {
    const int size = 257;
    const double pitch = 0.1e-3;
    const Grid<float> image = Diffraction(pattern(), size, size, pitch).apply(point(size, 128, 128));
    for (const double radius : {0.5e-3, 1.0e-3, 1.28e-3, 2.0e-3, 4.0e-3}) {
        double inside = 0, brightest_on_rim = 0;
        for (int row = 0; row < size; ++row)
            for (int column = 0; column < size; ++column) {
                const double r = pitch * std::hypot(column - 128, row - 128);
                const auto value = static_cast<double>(image(column, row));
                inside += r <= radius ? value : 0;
                if (std::abs(r - radius) < pitch)
                    brightest_on_rim = std::max(brightest_on_rim, value);
            }
        EXPECT_NEAR(inside, encircled(radius), 3 * std::sqrt(8 * radius / pitch) * 0.5 * brightest_on_rim + 0.004)
            << radius;
        // An aperture 10 % off is seen where the pattern is steep.
        if (radius < 1.1e-3) {
            EXPECT_GT(std::abs(inside - encircled(1.1 * radius)), 0.012);
        }
    }
}

TEST(Diffraction, KeepsTheLight) {
    const double pitch = 1e-3;
    const Diffraction diffraction(pattern(), 40, 40, pitch);
    for (const auto& [column, row] : {std::pair{20, 20}, std::pair{0, 0}, std::pair{39, 7}}) {
        const Grid<float> image = diffraction.apply(point(40, column, row));
        EXPECT_NEAR(sum(image), 1, 1e-5); // 1600 values rounded to float
    }
    const Grid<float> flat(40, 40, 3.0f);
    for (const float value : diffraction.apply(flat).values)
        EXPECT_NEAR(value, 3.0f, 1e-5f);
}

TEST(Diffraction, LongWavesKeepTheContrastOfTheTransferFunction) {
    const double pitch = 1e-3;
    const int size = 120;
    const Diffraction diffraction(pattern(), size, size, pitch);
    for (const int cycles : {6, 15, 30}) { // 20, 8 and 4 pixels a wave: whole waves and mirrored as they are
        Grid<float> image(size, size);
        for (int row = 0; row < size; ++row)
            for (int column = 0; column < size; ++column)
                image(column, row) = static_cast<float>(1 + 0.5 * std::cos(2 * pi * cycles * (column + 0.5) / size));
        const Grid<float> blurred = diffraction.apply(image);
        double amplitude = 0;
        for (int column = 0; column < size; ++column)
            amplitude += 2.0 / size * static_cast<double>(blurred(column, 60)) *
                         std::cos(2 * pi * cycles * (column + 0.5) / size);
        const double frequency = cycles / (size * pitch), cutoff = 2 * aperture / wavelength;
        const double expected = 0.5 * optics::circular_pupil_transfer(frequency, cutoff);
        EXPECT_NEAR(amplitude / expected, 1, 1e-5) << cycles;     // the pixels' own transfer is the trace's
        EXPECT_GT(std::abs(amplitude / 0.5 - 1), 0.04) << cycles; // it does something
    }
}

TEST(Diffraction, AMeasuredPointSpreadFunctionIsCentredAndNormalised) {
    Grid<float> spread(9, 7);
    spread(2, 3) = 6;
    spread(4, 3) = 2; // centroid at 2.5
    spread(2, 5) = 0;
    const double pitch = 1e-3;
    // At half the image's pitch the two points lie 0.25 pixels left and 0.75 right of the centre.
    const Grid<float> image = Diffraction(spread, 0.5 * pitch, 32, 32, pitch).apply(point(32, 16, 16));
    EXPECT_NEAR(sum(image), 1, 1e-6);
    // The point at -0.25 pixels covers [-0.5, 0], the other [0.5, 1]: three quarters in the middle, the rest beside it.
    EXPECT_NEAR(image(16, 16), 0.75f, 1e-6f);
    EXPECT_NEAR(image(17, 16), 0.25f, 1e-6f);
    EXPECT_THROW(Diffraction(spread, 2 * pitch, 32, 32, pitch), std::invalid_argument);
    EXPECT_THROW(Diffraction(Grid<float>(3, 3), pitch, 32, 32, pitch), std::invalid_argument);
}

// A point spread function from a file is collected over the image's pixels: that of the Airy pattern, sampled finely,
// is the fine image of the pattern added up to pixels.
TEST(Diffraction, BothWaysAgree) {
    constexpr int size = 48, parts = 11;
    const double pitch = 1e-3;
    const double fine = pitch / parts;
    const Grid<float> spread = Diffraction(pattern(), 257, 257, fine).apply(point(257, 128, 128));
    const Grid<float> by_file = Diffraction(spread, fine, size, size, pitch).apply(point(size, 22, 25));
    const Grid<float> by_pattern = Diffraction(pattern(), size * parts, size * parts, fine)
                                       .apply(point(size * parts, 22 * parts + 5, 25 * parts + 5));
    Grid<double> pixels(size, size);
    for (int row = 0; row < size * parts; ++row)
        for (int column = 0; column < size * parts; ++column)
            pixels(column / parts, row / parts) += static_cast<double>(by_pattern(column, row));
    // The tails that the file leaves out are 1 % of the light.
    for (int row = 20; row < 31; ++row)
        for (int column = 17; column < 28; ++column)
            EXPECT_NEAR(by_file(column, row), pixels(column, row), 0.02 * pixels(22, 25)) << column << " " << row;
}

TEST(AiryPattern, AveragesOverTheSpectrum) {
    const optics::AiryPattern two(aperture, optics::Spectrum::lines({0.45, 0.65}, {1, 3}));
    const double f = 400; // cycles per mm
    EXPECT_NEAR(two.transfer(f),
                0.25 * optics::circular_pupil_transfer(f, 2 * aperture / 0.45e-3) +
                    0.75 * optics::circular_pupil_transfer(f, 2 * aperture / 0.65e-3),
                1e-12);
    EXPECT_EQ(two.transfer(0), 1);
    EXPECT_DOUBLE_EQ(optics::circular_pupil_transfer(0.5, 1), 2 / pi * (pi / 3 - std::sqrt(3.0) / 4));
    EXPECT_EQ(optics::circular_pupil_transfer(1.01, 1), 0);
}

} // namespace
