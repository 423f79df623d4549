#include "optics/instrument/image_quality.hpp"

#include "core/mathematics/units.hpp"
#include "optics/aim/best_focus.hpp"
#include "optics/train/first_order.hpp"
#include "optics/waves/levelled_wavefront.hpp"
#include "parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace vkfv::optics {
namespace {

using test::surface;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Closed forms in double take a dozen operations, 1e-13 relative, of lengths to 100 mm.
constexpr double rounding = 1e-11;

TEST(PrincipalPlanes, OfAThickLens) {
    const double n = 1.5168, r1 = 50, r2 = -80, t = 6;
    const std::vector train = {surface(1 / r1, 0, 1, n), surface(1 / r2, t, n, 1)};
    const RayTransfer transfer = transfer_of_train(train);
    const double f = focal_length(transfer);
    const PrincipalPlanes planes = principal_planes(transfer);
    EXPECT_NEAR(planes.front, -f * (n - 1) * t / (n * r2), rounding);
    EXPECT_NEAR(planes.back, -f * (n - 1) * t / (n * r1), rounding);
    EXPECT_GT(planes.front, 1); // a thin lens, the wrong twin, has both at 0
}

TEST(PrincipalPlanes, OfABallLensAndAThinOne) {
    const double n = 1.5, radius = 2;
    const std::vector ball = {surface(1 / radius, 0, 1, n), surface(-1 / radius, 2 * radius, n, 1)};
    EXPECT_NEAR(principal_planes(transfer_of_train(ball)).front, radius, rounding); // both in its centre
    EXPECT_NEAR(principal_planes(transfer_of_train(ball)).back, -radius, rounding);
    const std::vector thin = {surface(1 / 40.0, 0, 1, n), surface(-1 / 40.0, 0, n, 1)};
    EXPECT_NEAR(principal_planes(transfer_of_train(thin)).front, 0, rounding);
    EXPECT_NEAR(principal_planes(transfer_of_train(thin)).back, 0, rounding);
}

// A single surface has both at its vertex, whatever the media; without their indices they would be elsewhere for a ball
// half in water.
TEST(PrincipalPlanes, BetweenMedia) {
    const double water = 1.33, glass = 1.5;
    const std::vector single = {surface(1 / 30.0, 0, water, glass)};
    EXPECT_NEAR(principal_planes(transfer_of_train(single), water, glass).front, 0, rounding);
    EXPECT_NEAR(principal_planes(transfer_of_train(single), water, glass).back, 0, rounding);
    // For two surfaces of powers a and b, t / n apart, H lies n1 (t / n) b / (a + b - a b t / n) behind the first
    // vertex.
    const double a = (glass - water) / 30, b = (1 - glass) / -20.0, reduced = 5 / glass;
    const std::vector lens = {surface(1 / 30.0, 0, water, glass), surface(-1 / 20.0, 5, glass, 1)};
    const double power = a + b - a * b * reduced;
    const PrincipalPlanes planes = principal_planes(transfer_of_train(lens), water, 1);
    EXPECT_NEAR(planes.front, water * reduced * b / power, rounding);
    EXPECT_NEAR(planes.back, -reduced * a / power, rounding);
    EXPECT_GT(std::abs(principal_planes(transfer_of_train(lens)).front - planes.front), 0.1);
}

TEST(StopImages, OfAStopBesideAThinLens) {
    const double f = 40;
    for (const double d : {10.0, 25.0, 90.0}) {
        const std::vector behind = {surface(1 / f, 0, 1, 1.5), surface(-1 / f, 0, 1.5, 1), surface(0, d, 1, 1)};
        const StopImage entrance = stop_seen_from_front(transfer_to_surface(behind, 2));
        EXPECT_NEAR(entrance.distance, 1 / (1 / d - 1 / f), rounding) << d;
        EXPECT_NEAR(entrance.magnification, 1 / (1 - d / f), rounding) << d;
        const std::vector before = {surface(0, 0, 1, 1), surface(1 / f, d, 1, 1.5), surface(-1 / f, 0, 1.5, 1)};
        const StopImage exit = stop_seen_from_behind(transfer_of_train(before));
        EXPECT_NEAR(exit.distance, 1 / (1 / f - 1 / d), rounding) << d;
        EXPECT_NEAR(exit.magnification, 1 / (1 - d / f), rounding) << d;
    }
    // Seen from water through a plane face, a stop at the distance d stands at n d.
    const std::vector window = {surface(0, 0, 1.33, 1), surface(0, 10, 1, 1)};
    EXPECT_NEAR(stop_seen_from_front(transfer_to_surface(window, 1), 1.33).distance, 13.3, rounding);
}

// Two ideal lenses with a stop in the focal plane between them: telecentric, aplanatic, without aberrations.
constexpr double object_focal_length = 20;
constexpr double image_focal_length = 200;
constexpr double magnification = -image_focal_length / object_focal_length;

Imaging ideal_microscope(double aperture, double index = 1) {
    auto objective = surface(0, 0, index, 1);
    objective.power = 1 / object_focal_length;
    objective.flags = physics::f64::SURFACE_IDEAL_LENS;
    auto stop = surface(0, object_focal_length, 1, 1);
    stop.flags = physics::f64::SURFACE_CLIPPED;
    stop.semi_diameter_squared = std::pow(object_focal_length * aperture, 2);
    auto tube_lens = surface(0, image_focal_length, 1, 1);
    tube_lens.power = 1 / image_focal_length;
    tube_lens.flags = physics::f64::SURFACE_IDEAL_LENS;
    return {.train = {objective, stop, tube_lens},
            .working_distance = index * object_focal_length,
            .detector_distance = image_focal_length,
            .detector_index = 1,
            .pupil_curvature = 0,
            .symmetric = true};
}

const std::vector<SpectralNode> green = {{.spectral = 0, .wavelength_um = 0.55, .weight = 1}};

WavefrontQuality wavefront_at(const Imaging& imaging, double x, double height,
                              const std::vector<SpectralNode>& spectrum = green) {
    std::vector<Wavefront> wavefronts;
    for (const SpectralNode& node : spectrum) {
        wavefronts.emplace_back(imaging, magnification, 0, node, glm::dvec2(x, 0), height);
    }
    return wavefront_quality(PointWaves(std::move(wavefronts)));
}

TEST(PointImage, OfAnIdealMicroscopeIsPerfect) {
    for (const auto& [aperture, index] : {std::pair{0.05, 1.0}, {0.5, 1.0}, {0.9, 1.0}, {1.2, 1.33}}) {
        const Imaging imaging = ideal_microscope(aperture, index);
        for (const double x : {0.0, 0.1}) {
            const PointImage image = point_image(imaging, outline_at(imaging, {x, 0}), 0, green);
            EXPECT_NEAR(image.rms_spot, 0, 1e-12) << aperture;
            EXPECT_NEAR(wavefront_at(imaging, x, 0).strehl, 1, 1e-6) << aperture;
            EXPECT_NEAR(wavefront_at(imaging, x, 0).rms, 0, 1e-7) << aperture;
            EXPECT_NEAR(image.centroid.x, -x * image_focal_length / object_focal_length, 1e-11) << aperture;
        }
        // The wrong twin is a depth of field out of focus, a phase of 2 pi over the cone where NA is low.
        const double depth = index * 0.55e-3 / (aperture * aperture);
        EXPECT_LT(wavefront_at(imaging, 0, depth).strehl, 0.5) << aperture;
    }
}

// A height z over focus adds the path n z (1 - cos theta), all but linear in the share s of the cone: Strehl = sinc^2
// (Born and Wolf, section 8.8.2). The rest is z NA^4 / 8 lambda of a wave, 1e-3 here. Marechal's exp(-(2 pi sigma)^2)
// must agree where it is near 1, and only there.
TEST(PointImage, DefocusIsASinc) {
    const double aperture = 0.05;
    const Imaging imaging = ideal_microscope(aperture);
    const Outline outline = outline_at(imaging, {0, 0});
    for (const double depths : {0.1, 0.3, 0.7, 1.5, -2.5}) { // n lambda / NA^2
        const double z = depths * 0.55e-3 / (aperture * aperture);
        const double phase = pi * depths / 2; // half the path's range, as a phase: (1 - cos) is NA^2 / 2
        const double sinc = std::sin(phase) / phase;
        const PointImage image = point_image(imaging, outline, z, green);
        const auto [rms, strehl] = wavefront_at(imaging, 0, z);
        EXPECT_NEAR(strehl, sinc * sinc, 2e-3) << depths;
        EXPECT_NEAR(rms, std::abs(depths) / 2 / std::sqrt(12), 2e-3 * std::abs(depths)) << depths;
        // The spot is |z| tan(theta) M, as a root mean square over the disc.
        EXPECT_NEAR(image.rms_spot, std::abs(z) * aperture / std::sqrt(2) * 10, 2e-3 * image.rms_spot) << depths;
        const double marechal = std::exp(-std::pow(2 * pi * rms, 2));
        if (std::abs(depths) <= 0.1) {
            EXPECT_NEAR(strehl, marechal, 1e-4);
        } else if (std::abs(depths) >= 1.5) {
            EXPECT_GT(std::abs(strehl - marechal), 0.01) << depths;
        }
        // The wrong twin has a tenth more defocus.
        if (depths == 0.7) {
            EXPECT_GT(std::abs(wavefront_at(imaging, 0, 1.1 * z).strehl - sinc * sinc), 0.05);
        }
    }
}

// At high aperture the truth is |integral of exp(i k z (1 - cos theta)) over s = sin^2 / NA^2|^2, by a midpoint rule of
// 20000 steps.
TEST(PointImage, DefocusAtHighAperture) {
    const double aperture = 0.8, z = 1e-3;
    const Imaging imaging = ideal_microscope(aperture);
    double real = 0, imaginary = 0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const double cosine = std::sqrt(1 - aperture * aperture * (i + 0.5) / steps);
        real += std::cos(2 * pi / 0.55e-3 * z * cosine) / steps;
        imaginary += std::sin(2 * pi / 0.55e-3 * z * cosine) / steps;
    }
    const double exact = real * real + imaginary * imaginary;
    EXPECT_NEAR(wavefront_at(imaging, 0, z).strehl, exact, 1e-3);
    EXPECT_LT(exact, 0.9);
}

// With half the light in focus at one wavelength and half out of it, spot and Strehl are the weighted means.
TEST(PointImage, OverASpectrum) {
    Imaging imaging = ideal_microscope(0.05);
    // A plate whose index rises with x moves the focus by t (n(x) - 1) / n(x) downwards.
    auto plate = surface(0, 0, 1, 1);
    plate.dispersion_after.c1 = 0.5;
    auto back = surface(0, 0.5, 1, 1);
    back.dispersion_before.c1 = 0.5;
    imaging.train.front().distance = 1;
    imaging.train.insert(imaging.train.begin(), {plate, back});
    imaging.working_distance -= 1.5;
    const std::vector<SpectralNode> both = {{.spectral = 0, .wavelength_um = 0.6, .weight = 0.5},
                                            {.spectral = 1, .wavelength_um = 0.5, .weight = 0.5}};
    const Outline outline = outline_at(imaging, {0, 0});
    const PointImage first = point_image(imaging, outline, 0, std::vector{SpectralNode{0, 0.6, 1}});
    const PointImage second = point_image(imaging, outline, 0, std::vector{SpectralNode{1, 0.5, 1}});
    const PointImage together = point_image(imaging, outline, 0, both);
    const std::vector<SpectralNode> one_alone = {{.spectral = 0, .wavelength_um = 0.6, .weight = 1}};
    const std::vector<SpectralNode> other_alone = {{.spectral = 1, .wavelength_um = 0.5, .weight = 1}};
    const double one = wavefront_at(imaging, 0, 0, one_alone).strehl;
    const double other = wavefront_at(imaging, 0, 0, other_alone).strehl;
    EXPECT_NEAR(one, 1, 1e-6);
    EXPECT_LT(other, 0.9);
    EXPECT_NEAR(first.rms_spot, 0, 1e-6 * second.rms_spot);
    EXPECT_NEAR(together.rms_spot, second.rms_spot / std::sqrt(2), 1e-6 * second.rms_spot);
    const double w1 = 1 / (0.6 * 0.6), w2 = 1 / (0.5 * 0.5);
    EXPECT_NEAR(wavefront_at(imaging, 0, 0, both).strehl, (w1 * one + w2 * other) / (w1 + w2), 1e-9);
    // The object seems raised by t (n - 1) / n = 1/6 mm.
    EXPECT_NEAR(least_spot(at_wavelength(imaging, 1), outline), -0.5 / 3, 1e-3 * 0.5 / 3);
    EXPECT_NEAR(best_focus(imaging, -10, outline, std::vector{SpectralNode{1, 0.5, 1}}), -0.5 / 3, 1e-3 * 0.5 / 3);
    // The two foci are weighted by the squares of their wave numbers.
    EXPECT_NEAR(best_focus(imaging, -10, outline, both), w2 / (w1 + w2) * -0.5 / 3, 1e-3 * 0.5 / 3);
}

// tests/references/image_quality_reference.py 30 1e5 5.958440, which shares no code, prints the spots and the centroid;
// tests/references/wavefront_reference.py the wavefront's RMS on the axis and the Strehl ratio. They are of the mixed
// characteristic, which images of waves are made of. About a sphere at the image, of 357 mm to the exit pupil, the
// wavefront is 0.6 % more, and at the edge the first program prints that alone.
TEST(ImageQuality, OfAnIndependentTracer) {
    auto description = test::microscope();
    description.detector_width = 1.28;
    const auto instrument = assemble(description);
    const auto quality = image_quality(description, instrument);
    const auto on_axis = wavefront_quality(instrument, {0, 0});
    const auto at_edge = wavefront_quality(instrument, quality.edge.position);
    EXPECT_NEAR(quality.axis.rms_spot * um_per_mm, 7.808412, 1e-3 * 7.808412);
    EXPECT_NEAR(on_axis.rms, 0.0164539, 1e-4 * 0.0164539);
    EXPECT_NEAR(on_axis.strehl, 0.9893558, 1e-6);
    EXPECT_NEAR(quality.edge.rms_spot * um_per_mm, 7.890760, 1e-3 * 7.890760);
    EXPECT_NEAR(at_edge.rms, 0.0177423, 6e-3 * 0.0177423);
    EXPECT_NEAR(at_edge.strehl, 0.9876344, 1e-4);
    EXPECT_NEAR(quality.edge.centroid.x, -0.638601633, 1e-6);
    EXPECT_NEAR(quality.edge_distortion, 0.638601633 / 0.64 - 1, 2e-6);
    // The twin that 1e-3 tells apart is the axis for the edge.
    EXPECT_GT(std::abs(quality.edge.rms_spot - quality.axis.rms_spot), 3e-3 * quality.axis.rms_spot);
    EXPECT_GT(std::abs(at_edge.rms - on_axis.rms), 0.01 * on_axis.rms);
}

// tests/references/wavefront_reference.py prints the values of the other objectives too. The wrong twin is the angle
// characteristic of the image: 0.0177 waves for the 20x and 0.0129 for the 100x.
TEST(ImageQuality, WavefrontsOfAnIndependentTracer) {
    const struct {
        const char* objective;
        double rms, strehl;
    } references[] = {{"5x_0.15", 0.0561162, 0.8826426},
                      {"20x_0.41", 0.0172343, 0.9883746},
                      {"50x_0.66", 0.0056384, 0.9987455},
                      {"100x_0.83", 0.0133448, 0.9929909}};
    for (const auto& [objective, rms, strehl] : references) {
        const auto quality = wavefront_quality(assemble(test::microscope(objective)), {0, 0});
        EXPECT_NEAR(quality.rms, rms, 1e-3 * rms) << objective;
        EXPECT_NEAR(quality.strehl, strehl, 1e-5) << objective;
    }
}

class Library : public ::testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(Library, IsFiniteAndConsistent) {
    const auto& [name, nominal_aperture] = GetParam();
    const auto description = test::microscope(name);
    const auto instrument = assemble(description);
    const auto quality = image_quality(description, instrument);
    const FirstOrder& first_order = instrument.first_order;
    for (const double value : {quality.objective.front_principal_plane, quality.objective.back_principal_plane,
                               quality.tube_lens.front_principal_plane, quality.tube_lens.back_principal_plane,
                               quality.entrance_pupil_height, quality.back_pupil_distance, quality.exit_pupil_distance,
                               quality.edge_distortion, quality.corner_distortion}) {
        EXPECT_TRUE(std::isfinite(value));
    }
    // Each figure is found in two ways: by the source that fills the pupil; by focal points; by paraxial rays from the
    // axis to the pupils' rims, whose angles go with the magnification; and by real rays with the sine condition, which
    // these objectives offend by less than 4 % (and paraxial pupils by 20 % at the highest aperture).
    EXPECT_NEAR(quality.back_pupil_radius / first_order.pupil_radius_in_source,
                std::abs(first_order.source_magnification), 1e-9);
    EXPECT_NEAR(quality.objective.front_principal_plane + first_order.working_distance, first_order.efl_objective,
                1e-9);
    EXPECT_NEAR(quality.tube_lens.back_principal_plane + first_order.efl_tube_lens,
                instrument.constants.detector_distance, 1e-9);
    EXPECT_NEAR(quality.image_aperture * std::abs(first_order.magnification), first_order.numerical_aperture,
                0.04 * first_order.numerical_aperture);
    EXPECT_NEAR(quality.beam_radius, first_order.numerical_aperture * first_order.efl_objective,
                0.04 * quality.beam_radius);
    EXPECT_NEAR(quality.exit_pupil_radius / quality.exit_pupil_distance * std::abs(first_order.magnification),
                quality.entrance_pupil_radius / quality.entrance_pupil_height, 1e-9);
    EXPECT_NEAR(quality.airy_radius, 0.61e-3 * test::d_line_um / first_order.numerical_aperture,
                1e-3 * quality.airy_radius);
    EXPECT_NEAR(first_order.numerical_aperture, nominal_aperture, 0.03 * nominal_aperture);
    EXPECT_NEAR(quality.magnification / first_order.magnification, 1, 5e-3);
    for (const PointImage* image : {&quality.axis, &quality.edge, &quality.corner}) {
        EXPECT_GT(image->rms_spot, 0);
        const auto [rms, strehl] = wavefront_quality(instrument, image->position);
        EXPECT_GT(strehl, 0.8); // patents of microscope objectives: diffraction-limited
        EXPECT_LE(strehl, 1);
        // Marechal's formula holds to fourth order in 2 pi sigma.
        const double phase = 2 * pi * rms;
        EXPECT_NEAR(strehl, std::exp(-phase * phase), std::pow(phase, 4));
        EXPECT_NEAR(image->relative_light, 1, 1e-3);
    }
    EXPECT_LT(std::abs(quality.corner_distortion), 5e-3);
    EXPECT_EQ(quality.axial_colour, 0);
    ASSERT_EQ(quality.axis_clipping.size(), 1u);
    EXPECT_TRUE(quality.axis_clipping.front().aperture_stop);
}

INSTANTIATE_TEST_SUITE_P(Microscopes, Library,
                         ::testing::Values(std::pair{"5x_0.15", 0.15}, std::pair{"10x_0.28", 0.28},
                                           std::pair{"20x_0.41", 0.41}, std::pair{"50x_0.66", 0.66},
                                           std::pair{"100x_0.83", 0.83}),
                         [](const auto& info) { return "scope_" + std::to_string(info.index); });

// A wide spectrum blurs an objective corrected for less; the figures of a line are the limit of a narrow spectrum.
TEST(ImageQuality, OfASpectrum) {
    auto description = test::microscope();
    const auto of_line = assemble(description);
    const auto line = image_quality(description, of_line);
    description.spectrum = Spectrum::gaussian(test::d_line_um, 1e-4);
    const auto of_narrow = assemble(description);
    const auto narrow = image_quality(description, of_narrow);
    EXPECT_NEAR(narrow.axis.rms_spot, line.axis.rms_spot, 1e-4 * line.axis.rms_spot);
    EXPECT_NEAR(wavefront_quality(of_narrow, {0, 0}).strehl, wavefront_quality(of_line, {0, 0}).strehl, 1e-4);
    description.spectrum = Spectrum::table({0.5, 0.65}, {1, 1});
    const auto instrument = assemble(description);
    const auto wide = image_quality(description, instrument);
    EXPECT_GT(wide.axis.rms_spot, 1.02 * line.axis.rms_spot);
    EXPECT_NE(wide.axial_colour, 0);
    EXPECT_NE(wide.lateral_colour, 0);
    // The nodes share the flux and keep its mean wavelength.
    const auto nodes = spectral_nodes(instrument);
    double sum = 0;
    double mean = 0;
    for (const SpectralNode& node : nodes) {
        sum += node.weight;
        mean += node.weight * node.wavelength_um;
    }
    EXPECT_EQ(nodes.size(), 32u);
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR(mean, 0.575, 1e-12);
}

TEST(Warnings, OfPixelsCoarserAndFinerThanTheOptics) {
    auto description = test::microscope();
    description.detector_width = 1.28; // 2 um a pixel in the object; lambda / NA is 2.12 um
    EXPECT_THAT(sentences_of(image_quality(description, assemble(description)).warnings), IsEmpty());
    description.detector_pixels = ImageSize::square(60);
    EXPECT_THAT(sentences_of(image_quality(description, assemble(description)).warnings),
                Contains(HasSubstr("coarser than the optics")));
    description.detector_pixels = ImageSize::square(980); // 0.1306 um; a tenth of Airy's radius is 0.1293 um
    EXPECT_THAT(sentences_of(image_quality(description, assemble(description)).warnings), IsEmpty());
    description.detector_pixels = ImageSize::square(1000);
    EXPECT_THAT(sentences_of(image_quality(description, assemble(description)).warnings),
                Contains(HasSubstr("far finer")));
}

TEST(Warnings, NameWhatClipsTheCone) {
    auto description = test::microscope();
    description.detector_width = 1.28;
    auto narrowed = description;
    // On the axis the beam fills 5.56 mm behind the objective.
    narrowed.tube_lens.surfaces.front().semi_diameter = 5;
    EXPECT_THAT(sentences_of(image_quality(narrowed, assemble(narrowed)).warnings),
                Contains(::testing::AllOf(HasSubstr("on the axis"), HasSubstr("(200mm 1) (100 % of the rim)"))));
    // Far out the front of the tube lens cuts one side.
    auto wide = description;
    wide.detector_width = 22;
    wide.detector_pixels = ImageSize::square(1100);
    wide.tube_lens.surfaces.front().semi_diameter = 7;
    const auto quality = image_quality(wide, assemble(wide));
    EXPECT_THAT(sentences_of(quality.warnings),
                Contains(::testing::AllOf(HasSubstr("field's corner"), HasSubstr("200mm 1"))));
    EXPECT_THAT(sentences_of(quality.warnings), Not(Contains(HasSubstr("on the axis"))));
    EXPECT_LT(quality.corner.relative_light, 0.9);
}

// If no light comes from the corner, its figures are undefined, not zero, and those of the axis stay.
TEST(ImageQuality, OfADarkCorner) {
    auto description = test::microscope();
    description.detector_width = 60;
    const auto instrument = assemble(description);
    const auto quality = image_quality(description, instrument);
    EXPECT_EQ(quality.corner.relative_light, 0);
    EXPECT_TRUE(std::isnan(quality.corner.rms_spot));
    EXPECT_TRUE(std::isnan(wavefront_quality(instrument, quality.corner.position).strehl));
    EXPECT_GT(wavefront_quality(instrument, {0, 0}).strehl, 0.9);
}

// A displaced train is looked at on all sides, and the worst is reported.
TEST(ImageQuality, OfADecentredTubeLens) {
    auto description = test::microscope();
    const auto straight = image_quality(description, assemble(description));
    description.tube_lens_placement.change.decentre_y = 1;
    const auto decentred = image_quality(description, assemble(description));
    EXPECT_NE(decentred.corner.position, straight.corner.position);
    EXPECT_GT(decentred.corner.rms_spot, straight.corner.rms_spot);
    EXPECT_NEAR(glm::length(decentred.corner.position), glm::length(straight.corner.position), 1e-12);
}

// The cone is the same; seen askew, one of its diameters shrinks by the tilt's cosine.
TEST(ImageQuality, OfATiltedDetector) {
    auto description = test::microscope();
    const double straight = image_quality(description, assemble(description)).image_aperture;
    const double tilt = 5 * radians_per_degree;
    description.detector_placement.change.tilt_x = tilt;
    const double tilted = image_quality(description, assemble(description)).image_aperture;
    EXPECT_LE(tilted, straight * 1.001);
    EXPECT_GE(tilted, straight * std::cos(tilt));
}

} // namespace
} // namespace vkfv::optics
