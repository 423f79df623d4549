#include "optics/media/spectrum.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "optics/media/glass_catalog.hpp"
#include "optics/train/train.hpp"
#include "parts.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace vkfv::optics {
namespace {

using test::chi_square_p;

constexpr double false_positive_rate = 1e-4; // of each statistical test here; seeds are fixed
constexpr int draws_made = 400000;

std::vector<double> drawn_wavelengths(const Spectrum& spectrum, std::uint32_t seed) {
    physics::f64::Instrument constants{};
    constants.spectrum_centre = spectrum.centre();
    constants.spectrum_half_width = spectrum.half_width();
    constants.spectral_bins = static_cast<int>(spectrum.bins.size());
    const TrainScene scene{.surfaces = {}, .bins = spectrum.bins};
    std::vector<double> wavelengths;
    for (std::uint32_t k = 0; k < draws_made; ++k) {
        const auto u = physics::f64::draw(seed, 0, {k, 0}, 0);
        const auto light = physics::f64::draw_light(scene, constants, u.u4);
        const double wavelength = 1 / light.wave_number;
        const auto same = physics::f64::light_of_spectral(constants, light.spectral);
        EXPECT_NEAR(same.wave_number, light.wave_number, 1e-14);
        EXPECT_LE(std::abs(light.spectral), 1 + 1e-12);
        wavelengths.push_back(wavelength);
    }
    return wavelengths;
}

// Counts in equal cells between two wavelengths, and two more beyond them.
std::vector<double> counts(const std::vector<double>& wavelengths, double low, double high, int cells) {
    std::vector<double> result(static_cast<std::size_t>(cells) + 2);
    for (const double wavelength : wavelengths) {
        const double place = std::floor((wavelength - low) / (high - low) * cells) + 1;
        result[static_cast<std::size_t>(std::clamp(place, 0.0, cells + 1.0))] += 1;
    }
    return result;
}

// The expected counts in the same cells, by a cumulative distribution.
std::vector<double> expected(const std::function<double(double)>& cumulative, double low, double high, int cells) {
    std::vector<double> result = {draws_made * cumulative(low)};
    for (int i = 0; i < cells; ++i) {
        const double step = (high - low) / cells;
        result.push_back(draws_made * (cumulative(low + (i + 1) * step) - cumulative(low + i * step)));
    }
    result.push_back(draws_made * (1 - cumulative(high)));
    return result;
}

TEST(Spectrum, DrawsLinesByTheirWeights) {
    const std::vector<double> lines = {0.4358, 0.5461, 0.5780, 0.6563};
    const auto spectrum = Spectrum::lines(lines, {1, 5, 0, 2});
    std::vector<double> seen(3);
    for (const double wavelength : drawn_wavelengths(spectrum, 31)) {
        const auto nearest =
            std::ranges::min_element(lines, {}, [&](double line) { return std::abs(line - wavelength); });
        ASSERT_NEAR(*nearest, wavelength, 1e-12);
        ASSERT_NE(*nearest, 0.5780); // has no weight
        seen[*nearest == 0.4358 ? 0 : *nearest == 0.5461 ? 1 : 2] += 1;
    }
    // With three cells the tail of two degrees of freedom is exp(-chi^2 / 2).
    const auto p = [&](const std::vector<double>& shares) {
        double chi_square = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            chi_square += std::pow(seen[i] - shares[i] * draws_made, 2) / (shares[i] * draws_made);
        }
        return std::exp(-0.5 * chi_square);
    };
    EXPECT_GT(p({0.125, 0.625, 0.25}), false_positive_rate);
    EXPECT_LT(p({0.128, 0.622, 0.25}), false_positive_rate); // wrong twin
    EXPECT_NEAR(spectrum.reference_um, (0.4358 + 5 * 0.5461 + 2 * 0.6563) / 8, 1e-15);
}

// The cut at four standard deviations s makes the variance s^2 (1 - 2 t phi(t) / (2 Phi(t) - 1)), t = 4, and the
// straight lines between points h = s / 16 apart add h^2 / 6.
TEST(Spectrum, DrawsAGaussian) {
    const double full_width = 0.03;
    const double sigma = full_width / (2 * std::sqrt(2 * std::log(2.0)));
    const auto spectrum = Spectrum::gaussian(0.53, full_width);
    const auto wavelengths = drawn_wavelengths(spectrum, 32);
    double mean = 0;
    double variance = 0;
    for (const double wavelength : wavelengths) {
        mean += wavelength / draws_made;
    }
    for (const double wavelength : wavelengths) {
        variance += (wavelength - mean) * (wavelength - mean) / draws_made;
    }
    const double truncated = 1 - 8 * std::exp(-8.0) / std::sqrt(2 * pi) + 1.0 / (6 * 256);
    // The bound is four standard errors: 6e-5.
    EXPECT_LT(std::abs(mean - 0.53), 4 * sigma / std::sqrt(draws_made));
    EXPECT_LT(std::abs(std::sqrt(variance / truncated) / sigma - 1), 4 / std::sqrt(2.0 * draws_made));
    EXPECT_EQ(spectrum.reference_um, 0.53);
    const auto gauss = [](double width) {
        return [width](double x) { return 0.5 * std::erfc(-(x - 0.53) / (width * std::sqrt(2.0))); };
    };
    const double low = 0.53 - 3 * sigma;
    const double high = 0.53 + 3 * sigma;
    const auto seen = counts(wavelengths, low, high, 40);
    EXPECT_GT(chi_square_p(seen, expected(gauss(sigma), low, high, 40)), false_positive_rate);
    EXPECT_LT(chi_square_p(seen, expected(gauss(1.02 * sigma), low, high, 40)), false_positive_rate); // wrong twin
}

// A table's flux is linear between its points; flat stretches of the same shares are the wrong twin.
TEST(Spectrum, DrawsATable) {
    const std::vector<double> points = {0.45, 0.50, 0.52, 0.58, 0.60, 0.65};
    const std::vector<double> densities = {0, 3, 3, 1, 0, 0};
    const auto spectrum = Spectrum::table(points, densities);
    std::vector<double> shares;
    double total = 0;
    double moment = 0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const double width = points[i + 1] - points[i];
        shares.push_back(0.5 * (densities[i] + densities[i + 1]) * width);
        total += shares.back();
        moment += test::integrate(
            [&](double x) {
                const double t = (x - points[i]) / width;
                return x * (densities[i] * (1 - t) + densities[i + 1] * t);
            },
            points[i], points[i + 1], 4);
    }
    const auto cumulative = [&](bool linear) {
        return [&, linear](double x) {
            double sum = 0;
            for (std::size_t i = 0; i < shares.size(); ++i) {
                const double t = std::clamp((x - points[i]) / (points[i + 1] - points[i]), 0.0, 1.0);
                const double both = densities[i] + densities[i + 1];
                const double slope = both > 0 ? (densities[i + 1] - densities[i]) / both : 0;
                sum += shares[i] / total * (linear ? t * (1 - slope) + slope * t * t : t);
            }
            return sum;
        };
    };
    const auto wavelengths = drawn_wavelengths(spectrum, 33);
    const auto seen = counts(wavelengths, 0.45, 0.60, 45);
    EXPECT_GT(chi_square_p(seen, expected(cumulative(true), 0.45, 0.60, 45)), false_positive_rate);
    EXPECT_LT(chi_square_p(seen, expected(cumulative(false), 0.45, 0.60, 45)), false_positive_rate);
    EXPECT_NEAR(spectrum.reference_um, moment / total, 1e-15);
    EXPECT_EQ(spectrum.longest_um, 0.60); // the empty stretch beyond is left out
    EXPECT_EQ(spectrum.bins.size(), 4u);
}

TEST(Spectrum, HasASingleLineWithoutRounding) {
    const auto spectrum = Spectrum::line(0.5876);
    EXPECT_TRUE(spectrum.monochromatic());
    EXPECT_EQ(spectrum.reference_um, 0.5876);
    EXPECT_EQ(spectrum.half_width(), 1);
    EXPECT_EQ(drawn_wavelengths(spectrum, 34).front(), 1 / (1 / 0.5876));
    EXPECT_TRUE(Spectrum::lines({0.5, 0.6}, {0, 2}).monochromatic());
}

TEST(Spectrum, RefusesWhatIsNone) {
    EXPECT_THROW(Spectrum::line(0), InputError);
    EXPECT_THROW(Spectrum::line(std::nan("")), InputError);
    EXPECT_THROW(Spectrum::lines({}, {}), InputError);
    EXPECT_THROW(Spectrum::lines({0.6, 0.5}, {1, 1}), InputError);
    EXPECT_THROW(Spectrum::lines({0.5, 0.5}, {1, 1}), InputError);
    EXPECT_THROW(Spectrum::lines({0.5, 0.6}, {1}), InputError);
    EXPECT_THROW(Spectrum::lines({0.5, 0.6}, {1, -1}), InputError);
    EXPECT_THROW(Spectrum::lines({0.5, 0.6}, {0, 0}), InputError);
    EXPECT_THROW(Spectrum::table({0.5}, {1}), InputError);
    EXPECT_THROW(Spectrum::table({0.5, 0.6}, {0, 0}), InputError);
    EXPECT_THROW(Spectrum::table({0.5, 0.6}, {1, std::nan("")}), InputError);
    EXPECT_THROW(Spectrum::gaussian(0.5, 0), InputError);
    EXPECT_THROW(Spectrum::gaussian(0.5, 0.4), InputError);
    std::vector<double> many(257, 1);
    std::vector<double> ascending;
    for (int i = 0; i < 257; ++i) {
        ascending.push_back(0.4 + 0.001 * i);
    }
    EXPECT_THROW(Spectrum::table(ascending, many), InputError);
}

// The largest difference of the polynomial from the catalogue's formula over the spectrum, and that of its linear part
// alone.
struct Deviation {
    double whole = 0;
    double linear = 0;
};

Deviation deviation(const char* glass, const Spectrum& spectrum) {
    const Medium medium = GlassCatalog::builtin().get(glass);
    const SpectralIndex index = spectral_index(medium, spectrum);
    Deviation result;
    for (int i = 0; i <= 400; ++i) {
        const double wavelength = spectrum.shortest_um + (spectrum.longest_um - spectrum.shortest_um) * i / 400;
        const double x = (1 / (wavelength * wavelength) - spectrum.centre()) / spectrum.half_width();
        const double exact = medium.index(wavelength);
        result.whole =
            std::max(result.whole, std::abs(index.centre + physics::f64::disperse(index.dispersion, x) - exact));
        result.linear = std::max(result.linear, std::abs(index.centre + index.dispersion.c1 * x - exact));
    }
    return result;
}

TEST(SpectralIndex, AgreesWithTheFormulaOverTheSpectrum) {
    for (const char* glass : {"N-BK7", "N-SF11", "F2", "CaF2", "Fused Silica"}) {
        const auto wide = deviation(glass, Spectrum::table({0.45, 0.65}, {1, 1}));
        EXPECT_LT(wide.whole, 1e-6) << glass;
        EXPECT_GT(wide.linear, 1e-6) << glass; // wrong twin: dispersion as a line
        EXPECT_LT(deviation(glass, Spectrum::gaussian(0.53, 0.03)).whole, 1e-9) << glass;
        EXPECT_LT(deviation(glass, Spectrum::lines({0.4861, 0.6563}, {1, 1e-3})).whole, 1e-6) << glass;
    }
    EXPECT_EQ(spectral_index(GlassCatalog::builtin().get("N-BK7"), Spectrum::line(0.55)).dispersion.c1, 0);
    EXPECT_EQ(deviation("N-BK7", Spectrum::line(0.55)).whole, 0);
}

// The truth is the back focal distance of a thick lens by the lensmaker's equation with the catalogue's indices: f (1 -
// (n - 1) t c1 / n) with 1 / f = (n - 1) (c1 - c2 + (n - 1) t c1 c2 / n).
TEST(Dispersion, ShiftsTheFocusOfASinglet) {
    const Medium glass = GlassCatalog::builtin().get("N-BK7");
    const double c1 = 1 / 51.68;
    const double c2 = -1 / 80.0;
    const double t = 5;
    Prescription lens;
    lens.medium_before = Medium::air();
    lens.surfaces.resize(2);
    lens.surfaces[0].curvature = c1;
    lens.surfaces[0].thickness = t;
    lens.surfaces[0].medium_after = glass;
    lens.surfaces[1].curvature = c2;
    lens.surfaces[1].medium_after = Medium::air();
    const auto spectrum = Spectrum::table({0.45, 0.55, 0.70}, {1, 2, 1});
    Pose end;
    auto placed = place_prescription(lens, spectrum, {}, Pose{}, end);
    link(placed, Pose{});
    const auto train = surfaces_of(placed);
    const auto traced = [&](double wavelength) {
        const double x = (1 / (wavelength * wavelength) - spectrum.centre()) / spectrum.half_width();
        // Spherical aberration goes with the height squared over the focal length: 1e-9 mm.
        constexpr double height = 1e-4;
        const auto result =
            trace_through(train, {.position = {height, 0, -1}, .direction = {0, 0, 1}, .path_length = 0}, 0, x);
        return -result.ray.position.x / result.ray.direction.x * result.ray.direction.z + result.ray.position.z;
    };
    const auto lensmaker = [&](double wavelength) {
        const double n = glass.index(wavelength);
        const double power = (n - 1) * (c1 - c2 + (n - 1) * t * c1 * c2 / n);
        return (1 - (n - 1) * t * c1 / n) / power;
    };
    for (const double wavelength : {0.4861, 0.5876, 0.6563}) {
        // The index is right to 1e-7, and the focal length of 60 mm with it.
        EXPECT_NEAR(traced(wavelength), lensmaker(wavelength), 2e-5) << wavelength;
    }
    const double shift = traced(0.6563) - traced(0.4861);
    EXPECT_NEAR(shift, lensmaker(0.6563) - lensmaker(0.4861), 4e-5);
    EXPECT_GT(shift, 0.9); // f / V = 61 mm / 64
}

} // namespace
} // namespace vkfv::optics
