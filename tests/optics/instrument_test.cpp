#include "optics/instrument/instrument.hpp"

#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "optics/train/first_order.hpp"
#include "optics/waves/point_waves.hpp"
#include "optics/waves/zernike.hpp"
#include "parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vkfv::optics {
namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::PATH_VIGNETTED;
using ::testing::HasSubstr;

std::vector<physics::f64::Surface> imaging_train(const Instrument& instrument) {
    const auto first = instrument.surfaces.begin() + instrument.constants.imaging_first;
    return {first, first + instrument.constants.imaging_count};
}

std::vector<physics::f64::Surface> illumination_train(const Instrument& instrument) {
    const auto first = instrument.surfaces.begin() + instrument.constants.illumination_first;
    return {first, first + instrument.constants.illumination_count};
}

// Two other programs print these values, here with every digit. Their sines are for a beam of given diameter; ours come
// from the semi-diameters, which differ from it by what the tables were rounded or widened.
TEST(Instrument, FirstOrderOfTheMicroscopes) {
    const auto ten = assemble(test::microscope("10x_0.28"));
    EXPECT_NEAR(ten.first_order.working_distance, 16.144167633337297, 1e-9);
    EXPECT_NEAR(ten.constants.detector_distance, 168.44219529398765, 1e-9);
    EXPECT_NEAR(ten.first_order.magnification, -9.999284329364341, 1e-9);
    EXPECT_NEAR(ten.first_order.numerical_aperture, 0.277261728, 1e-3 * 0.277261728);
    EXPECT_NEAR(ten.first_order.efl_objective, 20.000007181, 1e-9);
    EXPECT_NEAR(ten.first_order.efl_tube_lens, 199.985758388, 1e-9);
    EXPECT_EQ(ten.constants.magnification, ten.first_order.magnification);
    const double na = ten.first_order.numerical_aperture;
    EXPECT_NEAR(ten.first_order.depth_of_field, 0.587562e-3 / (na * na), 1e-15);
    EXPECT_NEAR(ten.first_order.pixel_pitch, 1.3 / 64 / 9.999284329364341, 1e-12);
    EXPECT_NEAR(ten.front_vertex_height, ten.first_order.working_distance - ten.first_order.best_focus_offset, 1e-15);

    const auto five = assemble(test::microscope("5x_0.15"));
    EXPECT_NEAR(five.first_order.working_distance, 65.90129633001145, 1e-9);
    EXPECT_NEAR(five.constants.detector_distance, 168.44219529398765, 1e-9);
    EXPECT_NEAR(five.first_order.magnification, -4.999643983663775, 1e-9);
    EXPECT_NEAR(five.first_order.numerical_aperture, 0.15, 0.025 * 0.15);
}

// With the nominal stops the apertures are nominal; 0.05 % is the pupil's spherical aberration at the stop.
TEST(Instrument, NominalApertures) {
    for (const auto& [name, na] : {std::pair{"20x_0.41", 0.406689448}, std::pair{"50x_0.66", 0.663616025},
                                   std::pair{"100x_0.83", 0.833807602}}) {
        EXPECT_NEAR(assemble(test::microscope(name)).first_order.numerical_aperture, na, 5e-4 * na) << name;
    }
}

// The marginal ray passes; a ray of slightly larger aperture does not.
TEST(Instrument, NumericalApertureIsTheLastRayToPass) {
    const auto instrument = assemble(test::microscope());
    const auto train = imaging_train(instrument);
    const double na = instrument.first_order.numerical_aperture;
    const auto status = [&](double sine) {
        return test::trace(train, {0, 0, -instrument.first_order.working_distance},
                           {sine, 0, std::sqrt(1 - sine * sine)}, 1u)
            .status;
    };
    EXPECT_EQ(status(na * (1 - 1e-9)), PATH_ALIVE);
    EXPECT_EQ(status(na * (1 + 1e-9)), PATH_VIGNETTED);
}

class ReferenceRays : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(ReferenceRays, ThroughTheWholeMicroscope) {
    const auto& [objective, file] = GetParam();
    const auto instrument = assemble(test::microscope(objective));
    const auto train = imaging_train(instrument);
    const auto rows = test::read_rows(test::source_folder() / "tests" / "data" / "rays" / file);
    ASSERT_EQ(rows.size(), 2000u);
    double position = 0;
    double direction = 0;
    double path = 0;
    double twin = 0; // the detector a micrometre off
    int vignetted = 0;
    for (const auto& row : rows) {
        const glm::dvec3 start(row[0], row[1], row[2] - instrument.first_order.working_distance);
        const glm::dvec3 cosines(row[3], row[4], row[5]);
        const auto result = test::trace(train, start, cosines);
        ASSERT_EQ(result.status, PATH_ALIVE);
        const auto landed = physics::f64::fly_to_plane(result.ray, instrument.constants.detector_distance, 1.0);
        const auto beside =
            physics::f64::fly_to_plane(result.ray, instrument.constants.detector_distance + mm_per_um, 1.0);
        position = std::max({position, std::abs(landed.position.x - row[6]), std::abs(landed.position.y - row[7])});
        direction = std::max({direction, std::abs(landed.direction.x - row[8]), std::abs(landed.direction.y - row[9]),
                              std::abs(landed.direction.z - row[10])});
        path = std::max(path, std::abs(landed.path_length - row[11]));
        twin = std::max(twin, std::abs(beside.position.x - row[6]));
        const auto clipped = test::trace(train, start, cosines, 1u);
        EXPECT_EQ(clipped.status == PATH_ALIVE, row[12] == 1);
        vignetted += clipped.status == PATH_VIGNETTED;
    }
    EXPECT_LT(position, 1e-9);
    EXPECT_LT(direction, 1e-12);
    EXPECT_LT(path, 1e-8);
    EXPECT_GT(twin, 1e-6);
    EXPECT_GT(vignetted, 0);
}

INSTANTIATE_TEST_SUITE_P(Microscopes, ReferenceRays,
                         ::testing::Values(std::pair{"10x_0.28", "scope_obj10x_028_tube200_nikon.csv"},
                                           std::pair{"5x_0.15", "scope_obj5x_015_tube200_nikon.csv"}),
                         [](const auto& info) { return info.index == 0 ? "ten" : "five"; });

// Another program takes the least-squares focus of a hexapolar grid of 20 rings in a collimated beam through the
// objective backward. Its outermost ring lies on the rim and counts in full, which overweights the margin: the integral
// over the pupil is 6.55 um instead of 7.98 um for the 10x.
TEST(BestFocus, OfOtherProgramsGrid) {
    struct Row {
        const char* name;
        double beam_radius; // mm
        double focus;       // mm, from the paraxial focus, in the direction of the light
    };
    for (const Row& row : {Row{"10x_0.28", 5.555557767318352, -7.979648474e-3},
                           {"5x_0.15", 6.0, 55.499741047e-3},
                           {"20x_0.41", 4.065040777350448, -7.030994663e-3}}) {
        const auto instrument = assemble(test::microscope(row.name));
        auto train = illumination_train(instrument);
        train.erase(train.begin(), train.begin() + 6); // the illuminator
        train.front().distance = 0;
        double numerator = 0;
        double denominator = 0;
        for (int ring = 1; ring <= 20; ++ring) {
            const auto result = test::trace(train, {row.beam_radius * ring / 20, 0, -1}, {0, 0, 1});
            const auto focal = physics::f64::fly_to_plane(result.ray, instrument.first_order.working_distance, 1.0);
            const double slope = focal.direction.x / focal.direction.z;
            numerator += ring * focal.position.x * slope;
            denominator += ring * slope * slope;
        }
        // The program prints nine decimals of micrometres; the paraxial plane is known to 1e-9 mm.
        EXPECT_NEAR(-numerator / denominator, row.focus, 2e-9) << row.name;
    }
}

// The mean square of the landings of random light, its directions uniform in their cosines, is least at the
// stated height. The step is the standard error of that minimum with 20000 rays times five, and the paraxial
// plane the wrong twin.
TEST(LeastSpot, OfRandomLight) {
    for (const char* name : {"10x_0.28", "5x_0.15"}) {
        const auto instrument = assemble(test::microscope(name));
        const auto train = imaging_train(instrument);
        const auto& first_order = instrument.first_order;
        for (const double field : {0.0, first_order.field_edge}) {
            std::mt19937_64 generator(7);
            std::uniform_real_distribution<double> uniform(-1, 1);
            // Landings are linear in the height to 1e-6 of the spot over these micrometres: two heights give
            // the slope.
            double n = 0, y = 0, r = 0, yy = 0, yr = 0, rr = 0; // sums of landings y and rates r
            std::vector<std::pair<double, double>> samples;
            const double reach = 1.3 * first_order.numerical_aperture;
            const Imaging imaging = imaging_of(instrument);
            const double expected = least_spot(imaging, outline_at(imaging, {field, 0}));
            while (samples.size() < 40000) {
                const double l = reach * uniform(generator);
                const double m = reach * uniform(generator);
                if (l * l + m * m >= 1) {
                    continue;
                }
                const glm::dvec3 direction(l, m, std::sqrt(1 - l * l - m * m));
                const auto landing = [&](double height, unsigned apertures) {
                    const auto result =
                        test::trace(train, {field, 0, height - first_order.working_distance}, direction, apertures);
                    return std::pair(result.status, physics::f64::fly_to_plane(
                                                        result.ray, instrument.constants.detector_distance, 1.0));
                };
                if (landing(0, 1u).first != PATH_ALIVE) {
                    continue;
                }
                const auto low = landing(expected - 1e-3, 0u).second.position;
                const auto high = landing(expected + 1e-3, 0u).second.position;
                for (const auto& [a, b] : {std::pair{low.x, high.x}, std::pair{low.y, high.y}}) {
                    samples.emplace_back(0.5 * (a + b), (b - a) / 2e-3);
                }
            }
            // x and y have centroids of their own.
            double numerator = 0, denominator = 0;
            std::vector<double> products;
            for (const std::size_t axis : {0u, 1u}) {
                n = y = r = yy = yr = rr = 0;
                for (std::size_t i = axis; i < samples.size(); i += 2) {
                    n += 1, y += samples[i].first, r += samples[i].second;
                }
                for (std::size_t i = axis; i < samples.size(); i += 2) {
                    const double dy = samples[i].first - y / n;
                    const double dr = samples[i].second - r / n;
                    numerator += dy * dr;
                    denominator += dr * dr;
                    products.push_back(dy * dr);
                }
            }
            double variance = 0;
            for (const double product : products) {
                variance += product * product;
            }
            const double deviation = -numerator / denominator;
            const double error = std::sqrt(variance) / denominator;
            // The false-positive rate is 6e-7 a case.
            EXPECT_LT(std::abs(deviation), 5 * error) << name << " " << field;
            EXPECT_GT(std::abs(deviation + expected), 5 * error) << name << " " << field;
        }
    }
}

// The figures are those of a tracer of a few lines of numpy that shares no code: a midpoint rule over 400 rings, whose
// error is below 5e-4 um.
TEST(LeastSpot, OfAnIndependentTracer) {
    EXPECT_NEAR(assemble(test::microscope("10x_0.28")).first_order.least_spot_offset, 6.685796e-3, 5e-7);
    EXPECT_NEAR(assemble(test::microscope("5x_0.15")).first_order.least_spot_offset, -54.978192e-3, 5e-7);
}

// tests/references/wavefront_reference.py, which shares no code, prints these values. Its pupil is that of the light
// that reaches the detector's middle, here that of a point of the paraxial plane: they differ by 3 nm.
TEST(BestFocus, OfAnIndependentTracer) {
    const auto focus = [](const char* objective) {
        return assemble(test::microscope(objective)).first_order.best_focus_offset;
    };
    EXPECT_NEAR(focus("5x_0.15"), -57.041226e-3, 5e-6);
    EXPECT_NEAR(focus("10x_0.28"), 5.961326e-3, 5e-6);
    EXPECT_NEAR(focus("20x_0.41"), 5.649179e-3, 5e-6);
    EXPECT_NEAR(focus("50x_0.66"), -0.080373e-3, 5e-6);
    EXPECT_NEAR(focus("100x_0.83"), -0.222717e-3, 5e-6);
}

// Best focus is where the mean square of W without piston and tilt is least, by the wavefront's polynomials over the
// traced pupil: on the axis and in the field's corner, for several wavelengths together.
TEST(BestFocus, IsWhereTheWavefrontVariesLeast) {
    auto description = test::microscope("5x_0.15");
    description.spectrum = Spectrum::lines({0.48, 0.59, 0.65}, {1, 2, 1});
    const Instrument instrument = assemble(description);
    const double side = instrument.first_order.field_edge;
    for (const bool corner : {false, true}) {
        const PointWaves image(instrument, corner ? glm::dvec2(std::sqrt(2.0) * side, 0) : glm::dvec2(0));
        const double focus = corner ? instrument.first_order.field_curvature_corner : 0;
        const auto variance = [&](double height) {
            double sum = 0;
            const PointWaves raised = image.at_height(height);
            for (const Wavefront& wavefront : raised.wavefronts()) {
                const auto coefficients = zernike_coefficients(wavefront, 37);
                for (std::size_t j = 3; j < coefficients.size(); ++j) {
                    sum += wavefront.weight() * coefficients[j] * coefficients[j];
                }
            }
            return sum;
        };
        const double step = 2e-3;
        const double below = variance(focus - step), middle = variance(focus), above = variance(focus + step);
        const double least = 0.5 * step * (below - above) / (below + above - 2 * middle);
        EXPECT_NEAR(least, 0, 5e-5) << corner; // mm; the pupil in the corner is no disc
    }
}

// Every random ray from the specimen that reaches the detector lies within the gate; a gate 5 % narrower
// loses some.
TEST(Gate, HoldsAllThatIsDetected) {
    for (const char* name : {"10x_0.28", "5x_0.15", "50x_0.66"}) {
        const auto instrument = assemble(test::microscope(name));
        const auto train = imaging_train(instrument);
        const auto& constants = instrument.constants;
        const double field = 1.2 * std::sqrt(2.0) * instrument.first_order.field_edge;
        const double reach = 1.15 * instrument.first_order.numerical_aperture;
        std::mt19937_64 generator(3);
        std::uniform_real_distribution<double> uniform(-1, 1);
        auto narrow = constants;
        narrow.gate_radius *= 0.95;
        int detected = 0;
        int outside = 0;
        int outside_narrow = 0;
        for (int i = 0; i < 100000; ++i) {
            // Rays are near the pupil's rim, where the gate matters.
            const double sine = reach * std::sqrt(1 - 0.4 * std::abs(uniform(generator)));
            const double azimuth = pi * uniform(generator);
            const glm::dvec3 direction(sine * std::cos(azimuth), sine * std::sin(azimuth), std::sqrt(1 - sine * sine));
            const double top = 0.2 * uniform(generator); // height of the top plane above best focus, mm
            const double below = 0.05 * std::abs(uniform(generator));
            // Rays are aimed at the plane of focus, so that they may be detected.
            const glm::dvec3 aim(field * uniform(generator), field * uniform(generator), 0);
            const glm::dvec3 position = aim + direction * ((top - below) / direction.z);
            const auto result =
                test::trace(train, position - glm::dvec3(0, 0, instrument.front_vertex_height), direction, 1u);
            const auto landed = physics::f64::fly_to_plane(result.ray, constants.detector_distance, 1.0);
            if (result.status != PATH_ALIVE || std::abs(landed.position.x) >= constants.detector_half_width ||
                std::abs(landed.position.y) >= constants.detector_half_height) {
                continue;
            }
            ++detected;
            outside += !physics::f64::passes_gate(constants, top, position, direction);
            outside_narrow += !physics::f64::passes_gate(narrow, top, position, direction);
        }
        EXPECT_GT(detected, 5000) << name;
        EXPECT_EQ(outside, 0) << name;
        EXPECT_GT(outside_narrow, 0) << name;
    }
}

// Every ray of the hemisphere that passes the illumination lies within the disc of directions that its place at the
// source is aimed into; a disc 5 % smaller loses some.
TEST(DirectedEmission, HoldsAllThatPasses) {
    for (const auto& [name, stop] :
         {std::pair{"10x_0.28", std::optional(0.85)}, std::pair{"10x_0.28", std::optional<double>()},
          std::pair{"50x_0.66", std::optional(0.3)}}) {
        auto description = test::microscope(name);
        description.field_stop_radius = stop;
        const auto instrument = assemble(description);
        const auto train = illumination_train(instrument);
        const double sine = instrument.constants.emission_sine;
        const double shift = instrument.constants.emission_shift;
        std::mt19937_64 generator(5);
        std::uniform_real_distribution<double> uniform(0, 1);
        int passed = 0;
        int outside_narrow = 0;
        for (int i = 0; i < 100000; ++i) {
            const auto ray = physics::f64::emit_from_disc(description.source.radius, std::min(1.0, 1.5 * sine), shift,
                                                          uniform(generator), uniform(generator), uniform(generator),
                                                          uniform(generator));
            const auto result = test::trace(
                train, ray.position - glm::dvec3(0, 0, instrument.constants.source_distance), ray.direction, 1u);
            if (result.status == PATH_ALIVE) {
                const double own = glm::length(glm::dvec2(ray.direction) - shift * glm::dvec2(ray.position));
                ++passed;
                EXPECT_LT(own, sine);
                outside_narrow += own > 0.95 * sine;
            }
        }
        EXPECT_GT(passed, 1000);
        EXPECT_GT(outside_narrow, 0);
        description.directed_emission = false;
        const auto analog = assemble(description);
        EXPECT_EQ(analog.constants.emission_sine, 1);
        EXPECT_EQ(analog.constants.emission_shift, 0);
    }
}

// The source is imaged into the pupil: light from its centre crosses the stop at the axis, light from its rim
// at the stop's edge if the source has the radius that fills the pupil; 5.788 times larger on the way.
TEST(Koehler, ImagesTheSourceIntoThePupil) {
    for (const char* name : {"10x_0.28", "20x_0.41", "5x_0.15"}) {
        const auto description = test::microscope(name);
        const auto instrument = assemble(description);
        auto train = illumination_train(instrument);
        std::size_t stop = 0;
        while (!std::string_view(instrument.surface_names[stop]).ends_with("aperture stop)")) {
            ++stop;
        }
        train.resize(stop + 1);
        const double source_distance = instrument.constants.source_distance;
        // Rays are paraxial: aberrations go with the cube of 1e-4 (and of the height, which is kept small too).
        const double small = 1e-4;
        const auto from_centre = test::trace(train, {0, 0, -source_distance}, {small, 0, 1});
        EXPECT_LT(std::abs(from_centre.ray.position.x), 1e-7) << name;
        const double filling = instrument.first_order.pupil_radius_in_source;
        const auto from_rim = test::trace(train, {small * filling, 0, -source_distance}, {0, 0, 1});
        EXPECT_NEAR(std::abs(from_rim.ray.position.x) / (small * std::sqrt(train.back().semi_diameter_squared)), 1,
                    1e-6)
            << name;
        const std::vector illuminator(train.begin(), train.begin() + 6);
        const auto image = image_of(transfer_of_train(illuminator), source_distance);
        EXPECT_NEAR(std::abs(image.magnification), 5.788, 1e-3) << name;
        EXPECT_NEAR(instrument.first_order.illumination_to_objective, train[6].distance, 1e-12) << name;
    }
}

// Field stop and specimen are conjugate: the image of a field stop of 0.85 mm is 0.85 times the ratio of the
// focal lengths of objective and field lens (149.97575906 mm), evenly lit: the mean square of the radius is
// half the square of the rim's.
TEST(Koehler, ImagesTheFieldStopOntoTheSpecimen) {
    const auto instrument = assemble(test::microscope());
    const auto train = illumination_train(instrument);
    const double expected = 0.85 * 20.000007181 / 149.97575906;
    std::mt19937_64 generator(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    double sum = 0;
    int count = 0;
    while (count < 40000) {
        const auto ray = physics::f64::emit_from_disc(0.96, instrument.constants.emission_sine,
                                                      instrument.constants.emission_shift, uniform(generator),
                                                      uniform(generator), uniform(generator), uniform(generator));
        const auto result = test::trace(train, ray.position - glm::dvec3(0, 0, instrument.constants.source_distance),
                                        ray.direction, 1u);
        if (result.status == PATH_ALIVE) {
            const auto arrived = physics::f64::fly_to_plane(result.ray, instrument.front_vertex_height, 1.0);
            sum += arrived.position.x * arrived.position.x + arrived.position.y * arrived.position.y;
            ++count;
        }
    }
    // The tolerance is five standard errors of the root (0.29 / sqrt(40000) of its square) and the half per cent by
    // which the sine condition bends the field; the wrong twin is a field lens of 155 mm.
    const double tolerance = (0.5 * 5 * 0.58 / std::sqrt(40000.0) + 0.005) * expected;
    EXPECT_NEAR(std::sqrt(2 * sum / count), expected, tolerance);
    EXPECT_GT(expected - expected * 149.97575906 / 155, tolerance);
}

TEST(Instrument, NamesItsSurfaces) {
    const auto instrument = assemble(test::microscope());
    ASSERT_EQ(instrument.surface_names.size(), instrument.surfaces.size());
    EXPECT_EQ(instrument.surface_names[2], "illumination 3 (koehler 3, field stop)");
    EXPECT_EQ(instrument.surface_names[6], "illumination 7 (10x_0.28 11)");
    EXPECT_EQ(instrument.surface_names[17], "imaging 1 (10x_0.28 1)");
    EXPECT_EQ(instrument.surface_names[28], "imaging 12 (200mm 1)");
    EXPECT_EQ(instrument.surfaces[0].distance, 0);
    EXPECT_EQ(instrument.surfaces[17].distance, 0);
    EXPECT_NEAR(instrument.surfaces[28].distance, 100, 1e-12); // a difference of places up to 300 mm off
}

TEST(Instrument, Warns) {
    EXPECT_TRUE(assemble(test::microscope()).warnings.empty());
    auto description = test::microscope();
    description.source.radius = 0.9;
    EXPECT_THAT(sentences_of(assemble(description).warnings), ::testing::ElementsAre(HasSubstr("does not fill")));
    description = test::microscope();
    description.field_stop_radius = 0.6; // 0.080 mm on the specimen; the corners are at 0.092 mm
    EXPECT_THAT(sentences_of(assemble(description).warnings), ::testing::ElementsAre(HasSubstr("does not cover")));
    description = test::microscope();
    description.illumination_to_objective = 100;
    EXPECT_THAT(sentences_of(assemble(description).warnings), ::testing::ElementsAre(HasSubstr("instead of into it")));
    description = test::microscope();
    description.detector_width = 40;
    description.field_stop_radius.reset();
    EXPECT_THAT(sentences_of(assemble(description).warnings), ::testing::ElementsAre(HasSubstr("clip their cones")));
}

TEST(Instrument, RefusesPartsThatDoNotFit) {
    const auto key_of = [](InstrumentDescription description) -> std::string {
        try {
            assemble(description);
        } catch (const InputError& error) {
            EXPECT_FALSE(error.problem().remedy.empty());
            return error.problem().key;
        }
        return "accepted";
    };
    auto description = test::microscope();
    description.source.radius = 0;
    EXPECT_EQ(key_of(description), "source.radius_mm");
    description = test::microscope();
    description.spectrum = optics::Spectrum::line(1.5);
    EXPECT_THAT(key_of(description), HasSubstr("index of"));
    description = test::microscope();
    description.illumination.source_distance.reset();
    EXPECT_EQ(key_of(description), "source.distance_mm");
    description = test::microscope();
    description.source.distance = 30; // its image stands in front of the field lens
    EXPECT_EQ(key_of(description), "illumination.objective_distance_mm");
    description = test::microscope();
    description.illumination.surfaces[2].role = PrescribedSurface::Role::refracting;
    EXPECT_EQ(key_of(description), "illumination.field_stop_radius_mm");
    description = test::microscope();
    for (auto& surface : description.objective.surfaces) {
        surface.role = PrescribedSurface::Role::refracting;
    }
    EXPECT_EQ(key_of(description), "objective.prescription");
    description = test::microscope();
    for (auto& surface : description.tube_lens.surfaces) {
        surface.curvature = -surface.curvature;
    }
    EXPECT_EQ(key_of(description), "tube_lens.prescription");
    description = test::microscope();
    description.objective.surfaces.clear();
    EXPECT_EQ(key_of(description), "objective.prescription");
}

} // namespace
} // namespace vkfv::optics
