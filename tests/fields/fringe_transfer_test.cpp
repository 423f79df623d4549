// The transfer function of an interferometer against closed forms and quadratures that share nothing with it.
#include "fields/fringe_transfer.hpp"
#include "fields/interferometers.hpp"
#include "optics/instrument/image_quality.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>

namespace vkfv {
namespace {

using namespace std::complex_literals;

constexpr double wavelength_um = 0.55;
const double wave_number = 2 * pi / from_um(wavelength_um);

fields::FringeTransfer transfer_of(double aperture, double fill = 1, const fields::ReferenceArm& arm = {},
                                   double half_range_um = 2) {
    const auto description = test::interferometer(aperture, 0.25, 32, 32, optics::Spectrum::line(wavelength_um));
    const auto instrument = optics::assemble(description);
    const auto wavefronts = optics::wavefronts_of(instrument, optics::spectral_nodes(instrument));
    return {wavefronts, arm, fill, 0, from_um(half_range_um), wavelength_um};
}

std::complex<double> signal(const fields::FringeTransfer& transfer, double height_um) {
    std::complex<double> sum = 0;
    for (int node = 0; node < transfer.nodes(); ++node) {
        sum += transfer.at(node, 0) * std::polar(1.0, transfer.wave_number(node) * from_um(height_um));
    }
    return sum;
}

// The image of a weak wave of heights over the heights, at a frequency in units of NA / lambda; `weigh`: the phase that
// a wave number makes of a height, over 2 k.
template <class Weigh>
double weak_transfer(const fields::FringeTransfer& transfer, double aperture, double frequency, const Weigh& weigh) {
    std::complex<double> wave = 0, level = 0;
    for (int node = 0; node < transfer.nodes(); ++node) {
        const double weight = weigh(transfer.wave_number(node) / (2 * wave_number));
        wave += weight * transfer.at(node, frequency * aperture / from_um(wavelength_um));
        level += weight * transfer.at(node, 0);
    }
    return (wave / level).real();
}

// The mean of exp(i 2 k gamma zeta) over a disc of direction cosines, by hand.
std::complex<double> flat_signal(double aperture, double height_um) {
    const double a = 2 * wave_number * from_um(height_um), least = std::sqrt(1 - aperture * aperture);
    const auto primitive = [&](double g) { return std::exp(1i * a * g) * (g / (1i * a) + 1 / (a * a)); };
    return 2 / (aperture * aperture) * (primitive(1) - primitive(least));
}

struct OfAperture {
    double aperture;
    double mean_cosine;
    std::array<double, 3> transfer; // at 0.5, 0.9 and 1.25 NA / lambda
};
// P. de Groot and X. Colonna de Lega's model, integrated by numpy on 800 x 800 source points.
const std::array of_apertures{OfAperture{0.3, 0.977151, {0.6876, 0.4481, 0.2592}},
                              OfAperture{0.8, 0.816667, {0.713, 0.4578, 0.2536}}};

TEST(FringeTransfer, ALevelMirrorHasTheSignalOfTheMeanOverThePupil) {
    for (const double aperture : {0.3, 0.55, 0.8}) {
        const auto transfer = transfer_of(aperture);
        for (const double height_um : {-1.0, -0.37, 0.11, 0.8}) {
            EXPECT_LT(std::abs(signal(transfer, height_um) - flat_signal(aperture, height_um)), 1e-3)
                << aperture << " " << height_um;
        }
        EXPECT_NEAR(std::abs(signal(transfer, 0)), 1, 1e-9);
    }
}

TEST(FringeTransfer, FringesAreWiderByTheMeanCosine) {
    for (const auto& [aperture, mean_cosine] : {std::pair{0.3, 0.977151}, {0.55, 0.92005}, {0.8, 0.816667}}) {
        const auto mean_of = [aperture = aperture](double fill) {
            const auto transfer = transfer_of(aperture, fill);
            double sum = 0;
            for (int node = 0; node < transfer.nodes(); ++node) {
                sum += transfer.at(node, 0).real() * transfer.wave_number(node) / (2 * wave_number);
            }
            return sum;
        };
        EXPECT_NEAR(mean_of(1), mean_cosine, 1e-4);
        EXPECT_GT(std::abs(mean_of(0.9) - mean_cosine), 1e-3); // the wrong twin: a condenser 10 % too narrow
    }
}

TEST(FringeTransfer, AWeakWaveHasTheContrastOfTheOverlapOfPupils) {
    for (const auto& [aperture, mean_cosine, expected] : of_apertures) {
        const auto transfer = transfer_of(aperture), narrow = transfer_of(aperture, 0.9);
        double narrow_error = 0, screen_error = 0;
        int k = 0;
        for (const double frequency : {0.5, 0.9, 1.25}) {
            const auto heights = [](double share) { return share; };
            const double here = weak_transfer(transfer, aperture, frequency, heights);
            EXPECT_NEAR(here, expected[static_cast<std::size_t>(k)], 0.003) << aperture << " " << frequency;
            const double twin = weak_transfer(narrow, aperture, frequency, heights);
            narrow_error = std::max(narrow_error, std::abs(twin - expected[static_cast<std::size_t>(k)]));
            // A thin screen exp(2 i k h), which shifts all light's phase alike.
            const double screen = weak_transfer(transfer, aperture, frequency, [](double) { return 1; });
            screen_error = std::max(screen_error, std::abs(screen - expected[static_cast<std::size_t>(k)]));
            ++k;
        }
        EXPECT_GT(narrow_error, 0.01) << aperture;
        if (aperture > 0.5) {
            EXPECT_GT(screen_error, 0.01);
        }
    }
}

// The overlap of two rings, by counting points of a square lattice.
TEST(FringeTransfer, AMirausMirrorHidesTheMiddleOfThePupil) {
    constexpr double aperture = 0.4, obscuration = 0.4;
    const fields::ReferenceArm arm{.kind = fields::ReferenceArm::Kind::mirau, .obscuration = obscuration};
    const auto transfer = transfer_of(aperture, 1, arm);
    constexpr int side = 600;
    const auto lit = [](double x, double y) {
        const double radius = std::hypot(x, y);
        return radius < 1 && radius > obscuration;
    };
    for (const double frequency : {0.3, 0.7, 1.2, 1.6}) {
        int both = 0, one = 0;
        for (int row = 0; row < side; ++row) {
            for (int column = 0; column < side; ++column) {
                const double x = (column + 0.5) / side * 2 - 1, y = (row + 0.5) / side * 2 - 1;
                one += lit(x, y) ? 1 : 0;
                both += lit(x, y) && lit(x + frequency, y) ? 1 : 0;
            }
        }
        EXPECT_NEAR(weak_transfer(transfer, aperture, frequency, [](double) { return 1; }),
                    static_cast<double>(both) / one, 0.003)
            << frequency;
    }
}

// Two waves of a spectrum are delayed by twice the glass's path, less what a shifted mirror makes up for.
TEST(FringeTransfer, GlassInOneArmLeavesItsDispersion) {
    constexpr double aperture = 0.05, thickness_um = 400; // so low an aperture that the light is nearly collimated
    auto description = test::interferometer(aperture, 2, 32, 32, optics::Spectrum::lines({0.5, 0.6}, {1, 1}));
    const auto instrument = optics::assemble(description);
    const auto wavefronts = optics::wavefronts_of(instrument, optics::spectral_nodes(instrument));
    const auto glass = optics::GlassCatalog::builtin().find("N-BK7");
    const fields::ReferenceArm arm{.glass_thickness = from_um(thickness_um), .glass = glass};
    const fields::FringeTransfer transfer(wavefronts, arm, 1, 0, from_um(2), 0.55);
    const auto k = [](double um) { return 2 * pi / from_um(um); };
    // N-BK7's indices and group index at 0.55 um by Sellmeier's formula with the maker's coefficients.
    const auto index = [](double um) {
        const double x = um * um;
        return std::sqrt(1 + 1.03961212 * x / (x - 0.00600069867) + 0.231792344 * x / (x - 0.0200179144) +
                         1.01046945 * x / (x - 103.560653));
    };
    const double group = index(0.55) - 0.55 * (index(0.5501) - index(0.5499)) / 2e-4;
    std::complex<double> expected = 0;
    for (const double um : {0.5, 0.6}) {
        const double phase =
            2 * from_um(thickness_um) * (k(um) * index(um) - k(0.55) * index(0.55) - group * (k(um) - k(0.55)));
        expected += 0.5 * std::polar(1.0, -phase);
    }
    EXPECT_LT(std::abs(signal(transfer, 0) - expected), 0.01);
    EXPECT_LT(std::abs(expected), 0.98); // there is dispersion enough to see
}

} // namespace
} // namespace vkfv
