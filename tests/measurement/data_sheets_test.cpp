// Published figures of objectives, telecentric lenses and cameras: a configuration takes what their data sheets state,
// and the instrument has what they state besides.
#include "camera/sensors.hpp"
#include "configuration/configuration.hpp"
#include "core/mathematics/units.hpp"
#include "measurement/scene/assembly.hpp"
#include "optics/media/light_emitting_diodes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace vkfv::measurement {
namespace {

const std::string disc_light = "[source]\nradius_mm = 1\nwavelength_um = 0.55\n";
const std::string small_chip = "[detector]\npixel_um = 3.45\npixels = 64\n";

Configuration of(const std::string& text) {
    return read_configuration(TomlTable::parse(text, "sheet.toml"), Needs::instrument);
}

optics::FirstOrder optics_of(const std::string& lenses, const std::string& detector = small_chip) {
    return assemble_instrument(of(disc_light + lenses + detector)).first_order;
}

std::string tube_lens_of(double focal_length) {
    return fmt::format("[tube_lens]\nkind = \"ideal\"\nfocal_length_mm = {}\n", focal_length);
}

struct Objective {
    const char* name; // with the maker who states the figures
    double magnification, numerical_aperture, tube_length, working_distance, focal_length;
    const char* immersion;
};
const Objective objectives[] = {
    {"Mitutoyo M Plan Apo 20x/0.42: hellberg.photo", 20, 0.42, 200, 20, 10, "AIR"},
    {"L Plan 20x/0.40, F = 200, WD = 12: radojuva.com, 2024", 20, 0.40, 200, 12, 10, "AIR"},
    {"Nikon LU Plan EPI 20x/0.45, WD = 4.5: D. Millard, photomacrography.net", 20, 0.45, 200, 4.5, 10, "AIR"},
    {"Olympus UMPLFN20XW 20x/0.5, f = 180/20, WD = 3.5: DCC-Lab, RayTracing", 20, 0.5, 180, 3.5, 9, "WATER"},
};

TEST(DataSheets, ObjectivesHaveTheirFocalLengthApertureAndWorkingDistance) {
    for (const Objective& objective : objectives) {
        SCOPED_TRACE(objective.name);
        const std::string named =
            fmt::format("[objective]\nkind = \"ideal\"\nmagnification = {}\nnumerical_aperture = {}\n",
                        objective.magnification, objective.numerical_aperture) +
            (objective.immersion == std::string("AIR") ? "" : fmt::format("immersion = \"{}\"\n", objective.immersion));
        const std::string length = fmt::format("tube_length_mm = {}\n", objective.tube_length);
        const std::string front = fmt::format("working_distance_mm = {}\n", objective.working_distance);
        const auto first = optics_of(named + length + front + tube_lens_of(objective.tube_length));
        EXPECT_NEAR(first.efl_objective, objective.focal_length, 1e-9);
        EXPECT_NEAR(first.magnification, -objective.magnification, 1e-9);
        EXPECT_NEAR(first.numerical_aperture, objective.numerical_aperture, 1e-6);
        EXPECT_NEAR(first.working_distance, objective.working_distance, 1e-9);
        // The front of the mount does nothing to light.
        const auto bare = optics_of(named + length + tube_lens_of(objective.tube_length));
        EXPECT_NEAR(first.best_focus_offset, bare.best_focus_offset, 1e-9);
        EXPECT_NEAR(first.depth_of_field, bare.depth_of_field, 1e-12);
    }
}

// hellberg.photo publishes a resolution lambda / (2 NA) of about 0.65 um and a depth of field lambda / NA^2 of about 3
// um, at 0.55 um.
TEST(DataSheets, TheDepthOfFieldOfAMitutoyoIsThatPublished) {
    const auto first =
        optics_of("[objective]\nkind = \"ideal\"\nmagnification = 20\nnumerical_aperture = 0.42\n" + tube_lens_of(200));
    EXPECT_NEAR(first.depth_of_field * um_per_mm, 3, 0.5);
}

// With the tube lens of another maker an objective has another magnification: 20x for 180 mm is 22.2x with 200 mm.
TEST(DataSheets, AnotherTubeLensMagnifiesByItsFocalLength) {
    const auto first = optics_of("[objective]\nkind = \"ideal\"\nmagnification = 20\ntube_length_mm = 180\n"
                                 "numerical_aperture = 0.45\n" +
                                 tube_lens_of(200));
    EXPECT_NEAR(first.magnification, -20 * 200.0 / 180.0, 1e-9);
}

TEST(DataSheets, MagnificationIsAnotherNameOfTheFocalLength) {
    const std::string rest = "numerical_aperture = 0.45\n" + tube_lens_of(200) + small_chip;
    const auto named = of(disc_light + "[objective]\nkind = \"ideal\"\nmagnification = 20\n" + rest).instrument;
    const auto given = of(disc_light + "[objective]\nkind = \"ideal\"\nfocal_length_mm = 10\n" + rest).instrument;
    EXPECT_EQ(named.objective.surfaces.front().ideal_power, given.objective.surfaces.front().ideal_power);
    EXPECT_EQ(named.objective.surfaces.back().semi_diameter, given.objective.surfaces.back().semi_diameter);
}

// The shoulder of an objective that is parfocal at 60 mm stands 60 mm over the focus, and the pupil of an ideal one two
// focal lengths over it: the tube lens stands at the same height, whichever of both its distance counts from.
TEST(DataSheets, ParfocalLengthIsWhereDistancesCountFrom) {
    const std::string objective = "[objective]\nkind = \"ideal\"\nmagnification = 20\nnumerical_aperture = 0.45\n";
    const auto of_shoulder = of(disc_light + objective + "parfocal_length_mm = 60\n" + tube_lens_of(200) +
                                "distance_mm = 100\n" + small_chip);
    EXPECT_NEAR(of_shoulder.instrument.objective_to_tube_lens, 60 + 100 - 2 * 10, 1e-12);
    EXPECT_THROW(
        of(disc_light + objective + "parfocal_length_mm = 5\n" + tube_lens_of(200) + "distance_mm = 1\n" + small_chip),
        InputError);
}

struct TelecentricLens {
    const char* name;
    double magnification, working_distance, numerical_aperture;
};
const TelecentricLens telecentric_lenses[] = {
    {"Opto Engineering TC4MHRP240-F, working f-number 8: opto-e.com, 2023", 0.073, 492.8, 0.073 / (2 * 8)},
    {"FA Lenses BTL0.334X138V1.1, f-number 6: falenses.com", 0.334, 138, 0.028},
    {"FA Lenses BTL0.516X111V1.1, f-number 8: falenses.com", 0.516, 111, 0.032},
};

std::string text_of(const TelecentricLens& lens) {
    return fmt::format("[objective]\nkind = \"telecentric\"\nmagnification = {}\nnumerical_aperture = {}\n"
                       "working_distance_mm = {}\n",
                       lens.magnification, lens.numerical_aperture, lens.working_distance);
}

TEST(DataSheets, TelecentricLensesHaveTheirMagnificationAndAperture) {
    for (const TelecentricLens& lens : telecentric_lenses) {
        SCOPED_TRACE(lens.name);
        const auto first = optics_of(text_of(lens));
        EXPECT_NEAR(first.magnification, -lens.magnification, 1e-9);
        EXPECT_NEAR(first.numerical_aperture, lens.numerical_aperture, 1e-6);
        EXPECT_NEAR(first.working_distance, lens.working_distance, 1e-9);
    }
}

// A lens that is telecentric on the object's side has its pupil at infinity.
TEST(DataSheets, TelecentricLensesSeeEveryPointFromStraightAbove) {
    const auto instrument = assemble_instrument(of(disc_light + text_of(telecentric_lenses[1]) + small_chip));
    EXPECT_NEAR(instrument.constants.gate_position, 0, 1e-12);
}

// opto-e.com publishes the field of TC4MHRP240-F on a sensor of 1 inch as 194.38 mm x 102.88 mm, and 70 um of
// resolution by Rayleigh's criterion at 520 nm. The pixels are those of the IMX255, as Matrix Vision's manual of the
// mvBlueFOX3 has them: 4112 x 2176 of 3.45 um.
TEST(DataSheets, TheFieldOfATelecentricLensIsThatPublished) {
    const auto first =
        optics_of(text_of(telecentric_lenses[0]), "[detector]\npixel_um = 3.45\npixels = [4112, 2176]\n");
    EXPECT_NEAR(2 * first.field_corner.x, 194.38, 0.0005 * 194.38);
    EXPECT_NEAR(2 * first.field_corner.y, 102.88, 0.0005 * 102.88);
    EXPECT_NEAR(0.61 * 0.520 / first.numerical_aperture, 70, 0.6);
}

struct Chip {
    const char* name;
    double diagonal; // mm
    const char* source;
};
const Chip chips[] = {
    {"IMX250", 11.1, "Adimec"},        {"IMX252", 8.9, "Adimec"},         {"IMX253", 17.6, "Adimec"},
    {"IMX255", 16.1, "Adimec"},        {"IMX265", 8.9, "acA2040-55uc"},   {"IMX226", 9.33, "acA4024-29uc"},
    {"IMX548", 8.8, "daA2448-70um"},   {"CMV4000", 16.0, "acA2040-90uc"}, {"PYTHON5000", 15.9, "acA2500-60uc"},
    {"MT9P031", 7.13, "daA2500-14um"},
};

// Published diagonals count the pixels at the edge too, which cameras leave out: the 2064 x 1544 pixels of an IMX265
// are set to 2048 x 1536, 0.7 % less.
TEST(DataSheets, CamerasByNameAreAsLargeAsPublished) {
    for (const Chip& chip : chips) {
        SCOPED_TRACE(fmt::format("{}: {}", chip.name, chip.source));
        const auto instrument = of(disc_light +
                                   "[objective]\nprescription = \"10x_0.28\"\n[tube_lens]\nprescription = "
                                   "\"200mm\"\n[detector]\ncamera = \"" +
                                   chip.name + "\"\n")
                                    .instrument;
        const double pitch = instrument.detector_width / instrument.detector_pixels.columns;
        const double diagonal = pitch * std::hypot(instrument.detector_pixels.columns, instrument.detector_pixels.rows);
        EXPECT_NEAR(diagonal, chip.diagonal, 0.01 * chip.diagonal);
    }
}

// FLIR publishes for the Blackfly S BFS-U3-244S8: IMX540, 5320 x 4600 pixels of 2.74 um. Under 20x a pixel sees 0.137
// um.
TEST(DataSheets, ACameraHasItsPixelsUnlessOthersAreGiven) {
    const std::string lenses =
        "[objective]\nkind = \"ideal\"\nmagnification = 20\nnumerical_aperture = 0.45\n" + tube_lens_of(200);
    const auto whole = of(disc_light + lenses + "[detector]\ncamera = \"IMX540\"\n").instrument;
    EXPECT_EQ(whole.detector_pixels.columns, 5320);
    EXPECT_EQ(whole.detector_pixels.rows, 4600);
    EXPECT_NEAR(whole.detector_width, 5320 * 2.74e-3, 1e-12);
    const auto middle = optics_of(lenses, "[detector]\ncamera = \"IMX540\"\npixels = 64\n");
    EXPECT_NEAR(middle.pixel_pitch * um_per_mm, 0.137, 1e-9);
    const auto binned = optics_of(lenses, "[detector]\ncamera = \"IMX540\"\npixels = 64\npixel_um = 5.48\n");
    EXPECT_NEAR(binned.pixel_pitch * um_per_mm, 0.274, 1e-9);
    const auto by_format = of(disc_light + lenses + "[detector]\nformat = \"2/3\"\npixels = [2448, 2048]\n").instrument;
    EXPECT_EQ(by_format.detector_width, 8.8);
}

// The canonical text in stack.toml gives the same instrument again.
TEST(DataSheets, CanonicalTextReadsBackToTheSameInstrument) {
    const std::string text =
        "[source]\nkind = \"ring\"\ninner_diameter_mm = 40\nouter_diameter_mm = 60\nworking_distance_mm = 15\n"
        "[source.spectrum]\nkind = \"led\"\ncolour = \"green\"\n"
        "[objective]\nkind = \"ideal\"\nmagnification = 20\nnumerical_aperture = 0.45\nworking_distance_mm = 4.5\n"
        "parfocal_length_mm = 60\n" +
        tube_lens_of(200) + "[detector]\ncamera = \"IMX250\"\n";
    const auto once = of(text), again = of(once.canonical);
    EXPECT_EQ(once.canonical, again.canonical);
    EXPECT_EQ(once.identity, again.identity);
    EXPECT_EQ(once.instrument.objective_to_tube_lens, again.instrument.objective_to_tube_lens);
    EXPECT_EQ(once.instrument.detector_width, again.instrument.detector_width);
    const auto telecentric = of(disc_light + text_of(telecentric_lenses[0]) + small_chip);
    EXPECT_EQ(telecentric.canonical, of(telecentric.canonical).canonical);
}

// A flat Lambertian ring of radii a and b at the height h lights the focus by pi L (sin^2 of b's angle from the axis
// less that of a's); the band that stands for it, of half the angle d about the direction t, by pi L sin 2t sin 2d.
double share_of_the_flat_rings_light(double inner, double outer, double height) {
    const auto source =
        of(fmt::format("[source]\nkind = \"ring\"\ninner_diameter_mm = {}\nouter_diameter_mm = {}\n"
                       "working_distance_mm = {}\n",
                       inner, outer, height) +
           "[objective]\nprescription = \"10x_0.28\"\n[tube_lens]\nprescription = \"200mm\"\n" + small_chip)
            .instrument.source;
    const auto& ring = source.ring.value();
    EXPECT_NEAR(ring.distance * std::sin(ring.elevation), height, 1e-12);
    EXPECT_NEAR(ring.distance * std::cos(ring.elevation), 0.25 * (inner + outer), 1e-12);
    const auto square_of_sine = [height](double radius) {
        return radius * radius / (radius * radius + height * height);
    };
    const double flat = square_of_sine(0.5 * outer) - square_of_sine(0.5 * inner);
    const double from_axis = 0.5 * pi - ring.elevation;
    const double half_angle = std::atan(0.5 * ring.width / ring.distance);
    return std::sin(2 * from_axis) * std::sin(2 * half_angle) / flat;
}

// A band of another width would be wrong at once; the band of the right width differs by the square of the ring's
// width.
TEST(DataSheets, ARingByItsDiametersLightsTheFocusAsAFlatRing) {
    struct Ring {
        double inner, outer, height;
    };
    for (const auto& [inner, outer, height] : {Ring{40, 60, 15}, Ring{66, 80, 25}, Ring{30, 34, 8}}) {
        const double quarter = 0.25 * (outer - inner);
        const double whole = share_of_the_flat_rings_light(inner, outer, height) - 1;
        const double half = share_of_the_flat_rings_light(inner + quarter, outer - quarter, height) - 1;
        EXPECT_LT(std::abs(whole), 0.05) << inner << " " << outer << " " << height;
        EXPECT_NEAR(whole / half, 4, 0.2) << inner << " " << outer << " " << height;
    }
}

// The elevation in place of the height is that of the middle of the ring's face.
TEST(DataSheets, ARingByItsElevationStandsAtItsHeight) {
    const std::string lenses =
        "[objective]\nprescription = \"10x_0.28\"\n[tube_lens]\nprescription = \"200mm\"\n" + small_chip;
    const std::string ring = "[source]\nkind = \"ring\"\ninner_diameter_mm = 40\nouter_diameter_mm = 60\n";
    const auto by_angle = of(ring + "elevation_deg = 45\n" + lenses).instrument.source.ring.value();
    const auto by_height = of(ring + "working_distance_mm = 25\n" + lenses).instrument.source.ring.value();
    EXPECT_NEAR(by_angle.distance, by_height.distance, 1e-12);
    EXPECT_NEAR(by_angle.width, by_height.width, 1e-12);
}

TEST(DataSheets, ALedOfAColourIsABellOfItsPeakAndWidth) {
    const std::string lenses = "[illumination]\nkind = \"ideal\"\ncondenser_focal_length_mm = 26\n"
                               "[objective]\nkind = \"ideal\"\nmagnification = 20\nnumerical_aperture = 0.45\n" +
                               tube_lens_of(200) + small_chip;
    const auto spectrum = [&](const std::string& lines) {
        return of("[source]\nradius_mm = 1\n[source.spectrum]\n" + lines + lenses).instrument.spectrum;
    };
    for (const auto& colour : optics::led_colours()) {
        if (colour.full_width_um > 0) {
            const auto by_name = spectrum(fmt::format("kind = \"led\"\ncolour = \"{}\"\n", colour.name));
            EXPECT_TRUE(by_name == spectrum(fmt::format("kind = \"gaussian\"\ncentre_um = {}\nfull_width_um = {}\n",
                                                        colour.peak_um, colour.full_width_um)))
                << colour.name;
        }
    }
    EXPECT_TRUE(spectrum("kind = \"led\"\npeak_um = 0.46\nfull_width_um = 0.025\n") ==
                spectrum("kind = \"gaussian\"\ncentre_um = 0.46\nfull_width_um = 0.025\n"));
    EXPECT_TRUE(spectrum("kind = \"led\"\ncolour = \"blue\"\npeak_um = 0.46\n") ==
                spectrum("kind = \"gaussian\"\ncentre_um = 0.46\nfull_width_um = 0.025\n"));
    // More of a white diode's light is beyond blue, by the phosphor, than is blue.
    const auto white = spectrum("kind = \"led\"\ncolour = \"white\"\n");
    EXPECT_GT(white.reference_um, 0.5);
    EXPECT_LT(white.shortest_um, 0.43);
    EXPECT_GT(white.longest_um, 0.65);
}

} // namespace
} // namespace vkfv::measurement
