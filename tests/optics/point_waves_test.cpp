#include "optics/waves/point_waves.hpp"

#include "core/mathematics/units.hpp"
#include "optics/waves/airy_pattern.hpp"
#include "optics/waves/quadrature.hpp"
#include "optics/waves/transfer.hpp"
#include "optics/waves/zernike.hpp"
#include "parts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace vkfv::optics {
namespace {

constexpr double wavelength = 0.55e-3; // mm

TEST(Quadrature, OfGaussAndLegendre) {
    for (const int count : {1, 2, 7, 64, 400}) {
        double ones = 0;
        double powers = 0;
        double exponential = 0;
        for (const QuadratureNode& node : gauss_legendre(count, 0, 2)) {
            ones += node.weight;
            powers += node.weight * std::pow(node.place / 2, 2 * count - 1);
            exponential += node.weight * std::exp(node.place);
        }
        EXPECT_NEAR(ones, 2, 1e-13) << count;
        EXPECT_NEAR(powers, 2.0 / (2 * count), 1e-12) << count;
        EXPECT_NEAR(exponential, std::exp(2) - 1, count > 6 ? 1e-12 : 3) << count;
    }
}

// Hopkins' table (1955) is paraxial, of a low aperture. W20 over the pupil's rim is a height of 2 W20 / NA^2.
TEST(Transfer, OfHopkinsDefocusedPupil) {
    constexpr double aperture = 0.01;
    const Wavefront focused(assemble(test::ideal_microscope(aperture)),
                            {.spectral = 0, .wavelength_um = 0.55, .weight = 1});
    const double cutoff = 2 * aperture / wavelength;
    constexpr std::array<std::array<double, 4>, 4> table = {{{0, 0.685, 0.391, 0.144},
                                                             {0.25, 0.576, 0.288, 0.122},
                                                             {0.5, 0.317, 0.085, 0.070},
                                                             {1, -0.068, -0.020, -0.010}}};
    for (const auto& [waves, quarter, half, three_quarters] : table) {
        const Wavefront wavefront = focused.at_height(2 * waves * wavelength / (aperture * aperture));
        const auto at = [&](double s, double azimuth) {
            return transfer(wavefront, s * cutoff * glm::dvec2(std::cos(azimuth), std::sin(azimuth)));
        };
        EXPECT_NEAR(at(0.25, 0).real(), quarter, 6e-4) << waves;
        EXPECT_NEAR(at(0.5, 1).real(), half, 6e-4) << waves;
        EXPECT_NEAR(at(0.75, 2).real(), three_quarters, 6e-4) << waves;
        EXPECT_NEAR(at(0.5, 1).imag(), 0, 1e-9) << waves;
        EXPECT_EQ(at(0, 0), 1.0);
        EXPECT_EQ(at(1.0001, 0), 0.0);
    }
    for (const double s : {0.01, 0.3, 0.6, 0.9, 0.99}) {
        EXPECT_NEAR(transfer(focused, {0, s * cutoff}).real(), circular_pupil_transfer(s, 1), 1e-6) << s;
    }
}

// The contrast H of the scalar Debye integral at z = lambda / (2 NA^2), and the Strehl ratio there.
struct DebyeFigures {
    double aperture, quarter, half, three_quarters, strehl;
};
class Debye : public ::testing::TestWithParam<DebyeFigures> {};

TEST_P(Debye, DefocusAtHighAperture) {
    const auto& [aperture, quarter, half, three_quarters, strehl] = GetParam();
    const PointWaves focused(assemble(test::ideal_microscope(aperture)));
    const double z = 0.5 * wavelength / (aperture * aperture);
    for (const double height : {z, -z}) {
        const PointWaves image = focused.at_height(height);
        EXPECT_NEAR(image.cutoff(), 2 * aperture / wavelength, 1e-6 * image.cutoff());
        EXPECT_NEAR(image.transfer({0.25 * image.cutoff(), 0}).real(), quarter, 6e-4);
        EXPECT_NEAR(image.transfer({0, 0.5 * image.cutoff()}).real(), half, 6e-4);
        EXPECT_NEAR(image.transfer({0.75 * image.cutoff(), 0}).real(), three_quarters, 6e-4);
        EXPECT_NEAR(image.point_spread(1e-3).strehl(), strehl, 6e-4);
    }
    EXPECT_NEAR(focused.point_spread(1e-3).strehl(), 1, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Apertures, Debye,
                         ::testing::Values(DebyeFigures{0.28, 0.572, 0.284, 0.121, 0.803},
                                           DebyeFigures{0.66, 0.548, 0.263, 0.114, 0.761},
                                           DebyeFigures{0.83, 0.521, 0.240, 0.105, 0.711}));

// Airy's pattern has rings at the zeros of J1, 3.8317, 7.0156, 10.1735, and known light within them.
TEST(PointSpread, OfAnIdealLensIsAirys) {
    for (const double aperture : {0.05, 0.8}) {
        const double unit = wavelength / (2 * pi * aperture);
        const PointSpread spread = PointWaves(assemble(test::ideal_microscope(aperture))).point_spread(12 * unit);
        const auto rings = spread.dark_rings(3);
        ASSERT_EQ(rings.size(), 3u);
        EXPECT_NEAR(rings[0] / unit, 3.831706, 1e-3);
        EXPECT_NEAR(rings[1] / unit, 7.015587, 1e-3);
        EXPECT_NEAR(rings[2] / unit, 10.173468, 1e-3);
        const auto light = spread.encircled(rings);
        EXPECT_NEAR(light[0], 0.8378, 1e-4);
        EXPECT_NEAR(light[1], 0.9099, 1e-4);
        EXPECT_NEAR(light[2], 0.9376, 1e-4);
        EXPECT_NEAR(spread.value({0, 0}), pi * aperture * aperture / (wavelength * wavelength),
                    1e-6 * spread.value({0, 0}));
    }
    // Paraxially, a quarter of a wave at the rim leaves a Strehl ratio of 8 / pi^2.
    const double z = 0.5 * wavelength / 1e-4;
    EXPECT_NEAR(PointWaves(assemble(test::ideal_microscope(0.01))).at_height(z).point_spread(1e-2).strehl(),
                8 / (pi * pi), 1e-4);
}

// The point spread's spectrum is the transfer function: two integrals over one pupil, here with coma, in a corner of
// the field and out of focus.
TEST(PointSpread, HasTheTransferFunctionAsItsSpectrum) {
    const Instrument instrument = assemble(test::microscope("20x_0.41"));
    const double edge = instrument.first_order.field_edge;
    const PointWaves image = PointWaves(instrument, {edge, -edge}).at_height(-1e-3);
    const double reach = 10e-3;
    const PointSpread spread = image.point_spread(reach);
    // The quadrature ends at 14 of the pattern's rings: light that lands beyond is missing.
    const glm::dvec2 frequency(0.3 * image.cutoff(), 0.2 * image.cutoff());
    std::complex<double> sum = 0;
    constexpr int rings = 48;
    for (const QuadratureNode& radius : gauss_legendre(rings, 0, reach)) {
        constexpr int spokes = 80;
        for (int i = 0; i < spokes; ++i) {
            const double azimuth = 2 * pi * i / spokes;
            const glm::dvec2 at = radius.place * glm::dvec2(std::cos(azimuth), std::sin(azimuth));
            sum += radius.weight * radius.place * 2 * pi / spokes * spread.value(at) *
                   std::polar(1.0, -2 * pi * glm::dot(frequency, at + spread.centre()));
        }
    }
    EXPECT_NEAR(std::abs(sum - image.transfer(frequency)), 0, 3e-3);
    EXPECT_GT(std::abs(image.transfer(frequency)), 0.1);
}

// tests/references/wavefront_reference.py, which shares no code, prints these values at its least variance: 5.961326 um
// over the paraxial plane for the 10x, -0.222717 um for the 100x.
TEST(PointWaves, OfAnIndependentTracer) {
    struct Figures {
        const char* objective;
        double plane_um, period_um;
        std::array<double, 5> zernike;  // 4, 11, 22, 37, 56
        std::array<double, 3> transfer; // at 0, 1, 2 half depths of field
    };
    const std::array figures = {Figures{"10x_0.28",
                                        5.961326,
                                        4,
                                        {0.000055, -0.010586, 0.000953, 0.012367, 0.002175},
                                        {0.659724, 0.555006, 0.293664}},
                                Figures{"100x_0.83",
                                        -0.222717,
                                        1,
                                        {0.000966, -0.013263, 0.000299, 0.000196, -0.000938},
                                        {0.555233, 0.392840, 0.093821}}};
    for (const auto& [objective, plane_um, period_um, zernike, expected] : figures) {
        const Instrument instrument = assemble(test::microscope(objective));
        const PointWaves at_focus(instrument);
        const double plane = plane_um * mm_per_um - instrument.first_order.best_focus_offset;
        const auto coefficients = zernike_coefficients(at_focus.at_height(plane).middle(), 56);
        EXPECT_NEAR(coefficients[3], zernike[0], 1e-4) << objective;
        EXPECT_NEAR(coefficients[10], zernike[1], 1e-4) << objective;
        EXPECT_NEAR(coefficients[21], zernike[2], 1e-4) << objective;
        EXPECT_NEAR(coefficients[36], zernike[3], 1e-4) << objective;
        EXPECT_NEAR(coefficients[55], zernike[4], 1e-4) << objective;
        const double aperture = at_focus.middle().largest_rim();
        const double half_depth = 0.5 * at_focus.middle().wavelength() / (aperture * aperture);
        for (std::size_t k = 0; k < expected.size(); ++k) {
            const double height = plane + static_cast<double>(k) * half_depth;
            const auto value = at_focus.at_height(height).transfer({0, um_per_mm / period_um});
            EXPECT_NEAR(value.real(), expected[k], 1e-3 * expected[k]) << objective << k;
        }
    }
}

// The script of OfAnIndependentTracer prints where gratings of these periods have their highest contrast, over the
// paraxial plane. Their mean is about the plane of least variance, 5.96 um for the 10x; the rays' least spot is 0.5 to
// 1 um off.
TEST(PointWaves, HasItsBestContrastWhereAnIndependentTracerHasIt) {
    struct Highest {
        const char* objective;
        double period_um, plane_um;
    };
    for (const auto& [objective, period_um, plane_um] :
         {Highest{"10x_0.28", 2.5, 6.0957}, Highest{"10x_0.28", 4, 6.1598}, Highest{"10x_0.28", 8, 5.6607},
          Highest{"5x_0.15", 4, -54.1591}}) {
        const Instrument instrument = assemble(test::microscope(objective));
        const PointWaves image(instrument);
        const double there = plane_um * mm_per_um - instrument.first_order.best_focus_offset;
        const double step = 0.4e-3; // mm
        const auto contrast = [&, period = period_um](double height) {
            return image.at_height(height).transfer({um_per_mm / period, 0}).real();
        };
        const double below = contrast(there - step), middle = contrast(there), above = contrast(there + step);
        const double off = 0.5 * step * (below - above) / (below + above - 2 * middle);
        EXPECT_LT(below + above, 2 * middle) << objective << period_um;
        EXPECT_NEAR(off * um_per_mm, 0, 0.02) << objective << period_um;
    }
}

// The order is that of Noll's table I: Z4 = sqrt(3) (2 rho^2 - 1), Z5 = sqrt(6) rho^2 sin 2 theta, ...
TEST(Zernike, InNollsOrder) {
    const glm::dvec2 at(0.3, 0.5);
    const double rho = glm::length(at), theta = std::atan2(at.y, at.x);
    EXPECT_NEAR(zernike(1, at), 1, 1e-14);
    EXPECT_NEAR(zernike(2, at), 2 * at.x, 1e-14);
    EXPECT_NEAR(zernike(3, at), 2 * at.y, 1e-14);
    EXPECT_NEAR(zernike(4, at), std::sqrt(3) * (2 * rho * rho - 1), 1e-14);
    EXPECT_NEAR(zernike(5, at), std::sqrt(6) * rho * rho * std::sin(2 * theta), 1e-14);
    EXPECT_NEAR(zernike(6, at), std::sqrt(6) * rho * rho * std::cos(2 * theta), 1e-14);
    EXPECT_NEAR(zernike(7, at), std::sqrt(8) * (3 * rho * rho * rho - 2 * rho) * std::sin(theta), 1e-14);
    EXPECT_NEAR(zernike(8, at), std::sqrt(8) * (3 * rho * rho * rho - 2 * rho) * std::cos(theta), 1e-14);
    EXPECT_NEAR(zernike(9, at), std::sqrt(8) * std::pow(rho, 3) * std::sin(3 * theta), 1e-14);
    EXPECT_NEAR(zernike(10, at), std::sqrt(8) * std::pow(rho, 3) * std::cos(3 * theta), 1e-14);
    EXPECT_NEAR(zernike(11, at), std::sqrt(5) * (6 * std::pow(rho, 4) - 6 * rho * rho + 1), 1e-14);
    EXPECT_NEAR(zernike(12, at), std::sqrt(10) * (4 * std::pow(rho, 4) - 3 * rho * rho) * std::cos(2 * theta), 1e-14);
    EXPECT_NEAR(zernike(13, at), std::sqrt(10) * (4 * std::pow(rho, 4) - 3 * rho * rho) * std::sin(2 * theta), 1e-14);
    EXPECT_NEAR(zernike(14, at), std::sqrt(10) * std::pow(rho, 4) * std::cos(4 * theta), 1e-14);
    EXPECT_EQ(zernike_order(22).radial, 6);
    EXPECT_EQ(zernike_order(22).azimuthal, 0);
    EXPECT_EQ(zernike_order(37).radial, 8);
    EXPECT_STREQ(zernike_name(11), "spherical aberration");
    EXPECT_STREQ(zernike_name(30), "");
}

} // namespace
} // namespace vkfv::optics
