#include "measurement/scene/phase_limits.hpp"

#include "optics/prescriptions/ideal_lens.hpp"
#include "specimen/description.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vkfv::measurement {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> sentences_of_limits(const PhaseLimits& limits) {
    return sentences_of(warnings_of(limits));
}

constexpr double aperture = 0.4;
constexpr double wavelength = 0.55e-3; // mm

// An ideal microscope of aperture 0.4 at 20x, its source as large as this share of the pupil.
optics::InstrumentDescription microscope(double fill) {
    constexpr double focal_length = 10, condenser = 30, field_lens = 150;
    optics::InstrumentDescription description;
    description.spectrum = optics::Spectrum::line(0.55);
    description.illumination = optics::ideal_koehler(condenser, field_lens);
    description.objective = optics::ideal_objective(focal_length, aperture);
    description.tube_lens = optics::ideal_lens(200);
    description.source.radius = fill * focal_length * aperture * condenser / field_lens;
    description.detector_width = 0.64;
    description.detector_pixels = ImageSize::square(128);
    description.directed_emission = false;
    return description;
}

optics::InstrumentDescription ring_microscope(double elevation) {
    auto description = microscope(1);
    description.source.ring = optics::RingLightDescription{.distance = 30,
                                                           .elevation = elevation,
                                                           .width = 0.1,
                                                           .segments = 1,
                                                           .fill = 1,
                                                           .on = {true},
                                                           .lit_radius = 0.1};
    return description;
}

constexpr double sinusoid_period = 0.004; // mm

// Heights of a sinusoid along x, amplitude and period in mm.
specimen::Specimen sinusoid(double amplitude, const specimen::Material& material, double period = sinusoid_period) {
    constexpr int side = 200;
    specimen::HeightField field{
        .heights = Grid<float>(side, side), .x_min = -0.025, .y_min = -0.025, .pitch_x = 0.00025, .pitch_y = 0.00025};
    for (int row = 0; row < side; ++row) {
        for (int column = 0; column < side; ++column) {
            const double x = field.x_min + column * field.pitch_x;
            field.heights(column, row) = static_cast<float>(amplitude * std::sin(2 * pi * x / period));
        }
    }
    return {.geometry = std::move(field), .material = material};
}

specimen::Material of_model(const char* model, std::vector<double> parameters = {}) {
    return {{{.model = model, .weight = 1, .parameters = std::move(parameters)}}};
}

PhaseLimits limits_of(double fill, const specimen::Specimen& specimen) {
    const auto description = microscope(fill);
    return phase_limits(description, optics::assemble(description), specimen);
}

const specimen::Material mirror = of_model("mirror");

TEST(PhaseLimits, AreClosedFormsOfTheInstrument) {
    const auto limits = limits_of(0.3, sinusoid(0.001, mirror));
    EXPECT_NEAR(limits.source_fill, 0.3, 1e-6);
    EXPECT_NEAR(limits.phase_height, wavelength / (4 * pi), 1e-12);
    EXPECT_NEAR(limits.depth_of_field, wavelength / (aperture * aperture), 1e-6 * limits.depth_of_field);
    EXPECT_EQ(limits.scatter_fill, 0);
    EXPECT_EQ(limits_of(1.5, sinusoid(0.001, mirror)).source_fill, 1) << "an overfilled pupil is filled";
}

// Half of the light of a Lambertian surface within the sine s_0 lies within s_0 / sqrt(2), so that it fills the pupil;
// the sample's median is off by 1 / sqrt(4 N) of the N = 8192 * 0.4^2 that enter it.
TEST(PhaseLimits, ScatterFillsThePupilAsItsLobeDoes) {
    const double four_errors = 4 / std::sqrt(4 * 8192 * aperture * aperture);
    EXPECT_NEAR(limits_of(1, sinusoid(0.001, of_model("lambertian"))).scatter_fill, 1, four_errors);
    // Henyey-Greenstein's lobe about the normal has the density p(alpha) cos(alpha) / N; the quadrature finds its
    // median.
    const double g = 0.95;
    std::vector<double> light{0};
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        const double sine = aperture * (i + 0.5) / steps;
        const double cosine = std::sqrt(1 - sine * sine);
        light.push_back(light.back() + sine / std::pow(1 + g * g - 2 * g * cosine, 1.5));
    }
    int median = 0;
    while (light[static_cast<std::size_t>(median)] < 0.5 * light.back()) {
        ++median;
    }
    const double expected = static_cast<double>(median) / steps * std::sqrt(2.0);
    // The median of N = 7400 paths has the standard error 1 / (2 f sqrt(N)), f its density: 0.0035 here, of which four
    // are allowed.
    EXPECT_NEAR(limits_of(1, sinusoid(0.001, of_model("henyey-greenstein", {g}))).scatter_fill, expected, 0.014);
    EXPECT_LT(expected, 0.5);
    // Far off its axis a lobe of the same g is broad: the light of a ring from 45 degrees that it scatters into the
    // aperture fills it.
    const auto description = ring_microscope(0.25 * pi);
    const auto of_ring =
        phase_limits(description, optics::assemble(description), sinusoid(0.001, of_model("henyey-greenstein", {g})));
    EXPECT_EQ(of_ring.source_fill, 0);
    EXPECT_GT(of_ring.scatter_fill, 0.8);
}

// The largest difference of contrasts with the light of a mirror, which is the source's image, a disc: by the areas of
// overlapping discs.
double error_of_disc(double fill) {
    constexpr int steps = 600, frequencies = 100;
    const auto place = [&](int step) { return fill * (2 * (step + 0.5) / steps - 1); };
    double largest = 0;
    for (int i = 1; i < frequencies; ++i) {
        const double frequency = 2.0 * i / frequencies;
        int lit = 0, middles = 0, ends = 0;
        for (int j = 0; j < steps * steps; ++j) {
            const int row = j / steps;
            const double x = place(j % steps), y = place(row);
            const bool is_lit = x * x + y * y <= fill * fill;
            lit += is_lit ? 1 : 0;
            middles += is_lit && std::hypot(std::abs(x) + 0.5 * frequency, y) <= 1 ? 1 : 0;
            ends += is_lit && std::hypot(x - frequency, y) <= 1 ? 1 : 0;
        }
        largest = std::max(largest, static_cast<double>(std::abs(middles - ends)) / lit);
    }
    return largest;
}

// A cell is 1/16 of the pupil's radius wide: what its rim takes or leaves moves a share by 0.03.
TEST(PhaseLimits, ContrastIsOffByWhatLightLacksOfAFilledPupil) {
    constexpr double of_cells = 0.03;
    for (const double fill : {0.3, 0.6, 0.8, 0.9}) {
        EXPECT_NEAR(limits_of(fill, sinusoid(0.001, mirror)).contrast_error, error_of_disc(fill), of_cells) << fill;
    }
    for (const char* model : {"mirror", "lambertian"}) {
        EXPECT_NEAR(limits_of(1.5, sinusoid(0.001, of_model(model))).contrast_error, 0, of_cells) << model;
    }
    EXPECT_NEAR(limits_of(0.2, sinusoid(0.001, of_model("lambertian"))).contrast_error, 0, of_cells);
    const specimen::Material half_mirror{{{.model = "mirror", .weight = 0.5, .parameters = {}},
                                          {.model = "lambertian", .weight = 0.5, .parameters = {}}}};
    const double lambertian_light = aperture * aperture; // light in the pupil, over the mirror's
    EXPECT_NEAR(limits_of(0.3, sinusoid(0.001, half_mirror)).contrast_error,
                error_of_disc(0.3) / (1 + lambertian_light), of_cells);
}

// A ring's light that a narrow lobe scatters fills the pupil's rim. Half of it lies farther out than that of a filled
// pupil, so that scatter_fill does not tell. The numbers are by numpy: Trowbridge and Reitz' facets with Smith's
// shadowing, averaged over the ring's azimuth, and areas of the pupil by a lattice of 401 points across.
TEST(PhaseLimits, ARingsLightAtThePupilsRimIsNoFilledPupil) {
    constexpr double of_cells = 0.03, degree = pi / 180;
    const auto limits = [](double elevation, double alpha) {
        const auto description = ring_microscope(elevation * degree);
        return phase_limits(description, optics::assemble(description), sinusoid(0.001, of_model("ggx", {alpha})));
    };
    const auto narrow = limits(64, 0.05);
    EXPECT_NEAR(narrow.contrast_error, 0.237, of_cells);
    EXPECT_GT(narrow.scatter_fill, 0.9);
    EXPECT_THAT(sentences_of_limits(narrow), ElementsAre(HasSubstr("a ring light nearer to the axis")));
    EXPECT_EQ(narrow.height_uncertainty(), narrow.depth_of_field);
    EXPECT_NEAR(limits(45, 0.05).contrast_error, 0.099, of_cells);
    EXPECT_NEAR(limits(64, 0.2).contrast_error, 0.029, of_cells);
    EXPECT_THAT(sentences_of_limits(limits(64, 0.2)), IsEmpty());
    const auto description = ring_microscope(64 * degree);
    const auto of_mirror = phase_limits(description, optics::assemble(description), sinusoid(0.001, mirror));
    EXPECT_EQ(of_mirror.contrast_error, 1) << "no light arrives but by slopes";
}

// Sq of a sinusoid is its amplitude over sqrt(2), of which a pixel's mean and the Gaussian filter of ten resolutions
// leave a share.
TEST(PhaseLimits, TextureIsTheStandardDeviationOfWhatTheObjectiveResolves) {
    const double amplitude = 0.001, period = 0.00412, pixel = 0.00025;
    const double nesting = 10 * wavelength / (2 * aperture);
    const double in_pixels = std::sin(pi * pixel / period) / (pi * pixel / period);
    const double filtered = 1 - std::exp(-std::log(2.0) * nesting * nesting / (period * period));
    EXPECT_NEAR(limits_of(1, sinusoid(amplitude, mirror, period)).texture,
                std::sqrt(0.5) * amplitude * in_pixels * filtered, 0.02 * amplitude);
    auto tilted = sinusoid(0, mirror);
    auto& heights = std::get<specimen::HeightField>(tilted.geometry).heights;
    for (int row = 0; row < heights.rows; ++row) {
        for (int column = 0; column < heights.columns; ++column) {
            heights(column, row) = 2e-5F * static_cast<float>(column);
        }
    }
    EXPECT_LT(limits_of(1, tilted).texture, 2e-6) << "a slope is no texture";
    auto step = sinusoid(0, mirror);
    auto& levels = std::get<specimen::HeightField>(step.geometry).heights;
    for (int row = 0; row < levels.rows; ++row) {
        for (int column = levels.columns / 2; column < levels.columns; ++column) {
            levels(column, row) = 0.01F;
        }
    }
    EXPECT_LT(limits_of(1, step).texture, 1e-5) << "10 um of height, and nothing beside the edge";
}

// Partially coherent images were computed of these cases: a mirror with a sinusoid of 4 um.
TEST(PhaseLimits, TellWhereImagesOfWavesDoNotHold) {
    const auto phase = HasSubstr("changes the light's phase alone");
    const auto unfilled = HasSubstr("spread unevenly over the objective's pupil");
    for (const double amplitude : {50e-6, 10e-6}) { // 50 and 10 nm
        const auto limits = limits_of(1.02, sinusoid(amplitude, mirror));
        EXPECT_THAT(sentences_of_limits(limits), ElementsAre(phase));
        EXPECT_EQ(limits.height_uncertainty(), limits.depth_of_field);
        EXPECT_THAT(sentences_of_limits(limits_of(0.3, sinusoid(amplitude, mirror))), ElementsAre(unfilled, phase));
    }
    EXPECT_THAT(sentences_of_limits(limits_of(0.2, sinusoid(0, mirror))), ElementsAre(unfilled))
        << "a grating of reflectance";
    const auto holds = limits_of(1.02, sinusoid(0.002, mirror));
    EXPECT_THAT(sentences_of_limits(holds), IsEmpty()) << "relief of 2 um, lit by a filled pupil";
    EXPECT_EQ(holds.height_uncertainty(), 0);
    EXPECT_THAT(sentences_of_limits(limits_of(0.3, sinusoid(50e-6, of_model("lambertian")))), IsEmpty());
    EXPECT_THAT(sentences_of_limits(limits_of(1.02, sinusoid(0, mirror))), IsEmpty()) << "a flat mirror, filled";
}

} // namespace
} // namespace vkfv::measurement
