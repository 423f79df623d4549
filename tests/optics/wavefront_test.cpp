#include "optics/waves/wavefront.hpp"

#include "core/mathematics/units.hpp"
#include "parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace vkfv::optics {
namespace {

constexpr double nm = 1e-6; // mm

SpectralNode reference_of(const Instrument& instrument) {
    return {.spectral = 0, .wavelength_um = 1 / std::sqrt(instrument.constants.spectrum_centre), .weight = 1};
}

// Points that fill a pupil, none of them where the fit has its own.
std::vector<glm::dvec2> pupil_points(const Wavefront& wavefront) {
    std::vector<glm::dvec2> points;
    for (int i = 0; i < 150; ++i) {
        const double azimuth = 2 * pi * 0.6180339887 * i;
        points.push_back(wavefront.chief() + 0.9999 * wavefront.rim(azimuth) * std::sqrt((i + 0.5) / 150) *
                                                 glm::dvec2(std::cos(azimuth), std::sin(azimuth)));
    }
    return points;
}

// Largest deviations from rays that are traced from where the wavefront says that they start.
struct Deviation {
    double landing = 0; // mm in the object
    double path = 0;    // mm
    double slope = 0;   // over the image's numerical aperture
};

Deviation deviation_from_rays(const Instrument& instrument, const Wavefront& wavefront, glm::dvec2 field,
                              double spectral) {
    const Imaging imaging = at_wavelength(imaging_of(instrument), spectral);
    const double plane = instrument.first_order.best_focus_offset + wavefront.height();
    const double magnification = instrument.first_order.magnification;
    const auto chief = imaging.trace(wavefront.object_point(), plane, wavefront.chief() / wavefront.index(), 0);
    Deviation deviation;
    for (const glm::dvec2 p : pupil_points(wavefront)) {
        const glm::dvec2 start = wavefront.object_point() - wavefront.displacement(p);
        const auto ray = imaging.trace(start, plane, p / wavefront.index(), 0);
        if (!ray || !chief) {
            return {1, 1, 1};
        }
        const glm::dvec2 miss = ray->position - magnification * field;
        deviation.landing = std::max(deviation.landing, glm::length(miss / magnification));
        // The ray misses the point by so little that its path there differs by the direction alone.
        const double traced = chief->path_length - ray->path_length + glm::dot(glm::dvec2(ray->direction), miss) +
                              glm::dot(p, wavefront.displacement(p));
        deviation.path = std::max(deviation.path, std::abs(traced - wavefront.path(p)));
        const glm::dvec2 slope =
            glm::dvec2(ray->direction) / ray->direction.z - glm::dvec2(chief->direction) / chief->direction.z;
        deviation.slope = std::max(deviation.slope, glm::length(slope - wavefront.image_slope(p)) *
                                                        std::abs(magnification) / wavefront.largest_rim());
    }
    return deviation;
}

void expect_rays(const Instrument& instrument, const Wavefront& wavefront, glm::dvec2 field, double spectral = 0,
                 double coarser = 1) {
    const Deviation deviation = deviation_from_rays(instrument, wavefront, field, spectral);
    EXPECT_LT(deviation.landing, coarser * nm);
    EXPECT_LT(deviation.path, coarser * 1e-5 * wavefront.wavelength());
    EXPECT_LT(deviation.slope, coarser * 1e-5);
}

class WavefrontOf : public ::testing::TestWithParam<std::tuple<const char*, double>> {};

// Rays that start where the gradient of W says land together, and their paths are those of W, in the middle and in the
// field's corner, in focus and out of it.
TEST_P(WavefrontOf, AgreesWithTracedRays) {
    const auto& [name, field] = GetParam();
    const Instrument instrument = assemble(test::microscope(name));
    const glm::dvec2 point = field * instrument.first_order.field_edge * glm::dvec2(1, -1);
    const Wavefront wavefront(instrument, reference_of(instrument), point);
    expect_rays(instrument, wavefront, point);
    const Wavefront raised = wavefront.at_height(5e-3);
    expect_rays(instrument, raised, point);
    // A raised plane's light goes inward.
    for (const glm::dvec2 p : pupil_points(wavefront)) {
        EXPECT_LT(glm::dot(raised.displacement(p) - wavefront.displacement(p), p - wavefront.chief()), 0);
    }
    EXPECT_NEAR(std::sqrt(wavefront.area() / pi), instrument.first_order.numerical_aperture,
                2e-3 * instrument.first_order.numerical_aperture);
}

INSTANTIATE_TEST_SUITE_P(Shipped, WavefrontOf,
                         ::testing::Combine(::testing::Values("5x_0.15", "10x_0.28", "20x_0.41", "50x_0.66",
                                                              "100x_0.83"),
                                            ::testing::Values(0.0, 1.0)),
                         [](const auto& info) { return "case_" + std::to_string(info.index); });

class Ideal : public ::testing::TestWithParam<double> {};

TEST_P(Ideal, LeavesDebyesDefocusAlone) {
    const double aperture = GetParam();
    const Instrument instrument = assemble(test::ideal_microscope(aperture));
    for (const double z : {0.0, 3e-3, -8e-3}) {
        const Wavefront wavefront(instrument, reference_of(instrument), glm::dvec2(0), z);
        for (const glm::dvec2 p : pupil_points(wavefront)) {
            EXPECT_NEAR(wavefront.path(p), z * (std::sqrt(1 - glm::dot(p, p)) - 1), 1e-9) << z;
            EXPECT_NEAR(glm::length(wavefront.image_slope(p)),
                        0.1 * glm::length(p) / std::sqrt(1 - 0.01 * glm::dot(p, p)), 1e-9);
        }
        // A train that is entered higher, traced instead of adding the defocus, gives the same path.
        Imaging imaging = imaging_of(instrument);
        const Wavefront traced(imaging, -10, z, reference_of(instrument));
        for (const glm::dvec2 p : pupil_points(traced)) {
            EXPECT_NEAR(traced.path(p), z * (std::sqrt(1 - glm::dot(p, p)) - 1), 1e-9) << z;
        }
        EXPECT_NEAR(wavefront.rim(1), aperture, 1e-9);
        EXPECT_TRUE(wavefront.passes({0, -0.999999 * aperture}));
        EXPECT_FALSE(wavefront.passes({0, -1.000001 * aperture}));
    }
}

INSTANTIATE_TEST_SUITE_P(Apertures, Ideal, ::testing::Values(0.28, 0.66, 0.83));

// Ways and media count: a cover glass under oil, a tube lens that stands aside, another wavelength, a pupil that two
// edges cut.
TEST(Wavefront, OfImmersionAndCoverGlass) {
    auto description = test::ideal_microscope(0.5);
    description.immersion = Medium::constant("water", 1.33);
    description.cover_glass =
        CoverGlass{.thickness = 0.17, .glass = Medium::constant("N-BK7", 1.5168), .distance = 2.0};
    const Instrument instrument = assemble(description);
    const Wavefront wavefront(instrument, reference_of(instrument), {0.02, 0.03}, 2e-3);
    EXPECT_EQ(wavefront.index(), 1.33);
    expect_rays(instrument, wavefront, {0.02, 0.03});
}

TEST(Wavefront, OfADecentredTubeLens) {
    auto description = test::microscope();
    description.tube_lens_placement.change.decentre_y = 1;
    const Instrument instrument = assemble(description);
    const Wavefront wavefront(instrument, reference_of(instrument));
    EXPECT_NEAR(wavefront.object_point().y, 0.1, 0.01); // what the detector's middle sees
    expect_rays(instrument, wavefront, {0, 0});
}

TEST(Wavefront, OfAnotherWavelength) {
    auto description = test::microscope();
    description.spectrum = Spectrum::lines({0.5, 0.6}, {1, 1});
    const Instrument instrument = assemble(description);
    const auto nodes = spectral_nodes(instrument);
    ASSERT_EQ(nodes.size(), 2u);
    for (const SpectralNode& node : nodes) {
        const Wavefront wavefront(instrument, node);
        EXPECT_NEAR(wavefront.wavelength(), node.wavelength_um * mm_per_um, 1e-15);
        expect_rays(instrument, wavefront, {0, 0}, node.spectral);
    }
    // The wrong twin is the rays of the other wavelength.
    EXPECT_GT(deviation_from_rays(instrument, Wavefront(instrument, nodes[0]), {0, 0}, nodes[1].spectral).landing,
              10 * nm);
}

TEST(Wavefront, EndsWhereAnEdgeClips) {
    auto description = test::microscope();
    description.detector_width = 22;
    description.detector_pixels = ImageSize::square(1100);
    description.tube_lens.surfaces.front().semi_diameter = 7;
    const Instrument instrument = assemble(description);
    for (const double x : {0.8, 1.1}) { // the second one's paraxial chief ray is stopped
        const glm::dvec2 corner(x, x);
        const Wavefront wavefront(instrument, reference_of(instrument), corner);
        expect_rays(instrument, wavefront, corner, 0, 150); // a pupil with two corners is fitted less well
        int wrong = 0;
        EXPECT_LT(wavefront.area(), 0.9 * Wavefront(instrument, reference_of(instrument)).area());
        // Rays are a little inside the rim and a little outside it.
        const Imaging imaging = imaging_of(instrument);
        for (int i = 0; i < 90; ++i) {
            const double azimuth = 2 * pi * (i + 0.3) / 90;
            for (const double share : {0.998, 1.002}) {
                const glm::dvec2 p = wavefront.chief() +
                                     share * wavefront.rim(azimuth) * glm::dvec2(std::cos(azimuth), std::sin(azimuth));
                const auto ray = imaging.trace(wavefront.object_point() - wavefront.displacement(p),
                                               instrument.first_order.best_focus_offset, p, 1);
                EXPECT_EQ(wavefront.passes(p), share < 1) << azimuth;
                wrong += ray.has_value() == (share < 1) ? 0 : 1;
            }
        }
        EXPECT_LE(wrong, 4) << x; // where two edges meet, the rim has corners
    }
    // Far outside the field no light arrives.
    EXPECT_EQ(Wavefront(instrument, reference_of(instrument), {6, 0}).largest_rim(), 0);
}

} // namespace
} // namespace vkfv::optics
