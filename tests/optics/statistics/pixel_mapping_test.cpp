// Pixels look where closed forms of displaced ideal lenses and of a ball lens say, and light that is traced the other
// way, from there to the detector, lands in them.
#include "optics/instrument/pixel_mapping.hpp"

#include "core/mathematics/units.hpp"
#include "optics/instrument/image_quality.hpp"
#include "optics/parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace vkfv::optics {
namespace {

constexpr double nm = 1e-6; // mm

glm::dvec2 half_field(const InstrumentDescription& description, const Instrument& instrument) {
    const ImageSize pixels = description.detector_pixels;
    return 0.5 * instrument.first_order.pixel_pitch * glm::dvec2(pixels.columns, pixels.rows);
}

// Nominal places all over the field, none of them a node of the mapping.
std::vector<glm::dvec2> somewhere(glm::dvec2 half_field, int count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> within(-1, 1);
    std::vector<glm::dvec2> places;
    for (int k = 0; k < count; ++k) {
        const double x = within(random);
        places.push_back(half_field * glm::dvec2(x, within(random)));
    }
    return places;
}

// The largest distance, in pixels, between a nominal place and where on the detector the light lands that leaves the
// place and the height that the mapping tells: light of the whole cone and spectrum, traced forward.
double largest_miss(const InstrumentDescription& description, const Instrument& instrument,
                    const PixelMapping& mapping) {
    const Imaging imaging = imaging_of(instrument);
    const Spectrum& spectrum = description.spectrum;
    const auto nodes = spectral_nodes(spectrum.bins, spectrum.centre(), spectrum.half_width(), 12);
    double largest = 0;
    for (const glm::dvec2 nominal : somewhere(half_field(description, instrument), 8)) {
        const glm::dvec2 place = mapping.place(nominal);
        const double height = instrument.first_order.best_focus_offset + mapping.focus(nominal);
        const PointImage image = point_image(imaging, outline_at(imaging, place), height, nodes);
        const glm::dvec2 miss = image.centroid / instrument.first_order.magnification - nominal;
        largest = std::max(largest, glm::length(miss) / instrument.first_order.pixel_pitch);
    }
    return largest;
}

double largest_aside(const InstrumentDescription& description, const Instrument& instrument,
                     const PixelMapping& mapping) {
    double largest = 0;
    for (const glm::dvec2 nominal : somewhere(half_field(description, instrument), 12)) {
        largest = std::max(largest, glm::distance(mapping.place(nominal), nominal));
    }
    return largest / instrument.first_order.pixel_pitch;
}

// Behind ideal lenses of 20 and 200 mm a pixel at X on the detector's plane receives the light that goes to the tube
// lens with the direction (c - X) / 200, c the lens' centre, and that leaves the objective's own axis at 20 / 200 (c -
// X).
TEST(PixelMapping, OfDisplacedIdealLensesIsTheClosedForm) {
    const glm::dvec2 by(0.1, -0.06);
    struct Case {
        const char* name;
        Placement InstrumentDescription::*part;
        double share; // shift of the pixels' places over the part's displacement
    };
    for (const Case& one : {Case{"detector", &InstrumentDescription::detector_placement, -0.1},
                            Case{"tube lens", &InstrumentDescription::tube_lens_placement, 0.1},
                            Case{"objective", &InstrumentDescription::objective_placement, 1}}) {
        auto description = test::ideal_microscope(0.2);
        (description.*one.part).change.decentre_x = by.x;
        (description.*one.part).change.decentre_y = by.y;
        const Instrument instrument = assemble(description);
        const PixelMapping mapping(description, instrument);
        for (const glm::dvec2 nominal : somewhere(half_field(description, instrument), 12)) {
            EXPECT_LT(glm::distance(mapping.place(nominal), nominal + one.share * by), nm) << one.name;
        }
        EXPECT_LT(glm::distance(mapping.deviation().shift, one.share * by), nm) << one.name;
        EXPECT_NEAR(mapping.deviation().amplification.x, 1, 1e-5) << one.name;
        EXPECT_LT(mapping.deviation().residual, nm) << one.name;
        EXPECT_LT(mapping.deviation().error, nm) << one.name;
    }
}

TEST(PixelMapping, OfCentredIdealLensesIsNominal) {
    const auto description = test::ideal_microscope(0.2);
    const Instrument instrument = assemble(description);
    const PixelMapping mapping(description, instrument);
    EXPECT_LT(largest_aside(description, instrument, mapping), 1e-6);
    EXPECT_EQ(mapping.deviation().shift, glm::dvec2(0));
    EXPECT_NEAR(mapping.deviation().amplification.y, 1, 1e-9);
    EXPECT_LT(std::abs(mapping.focus({0.02, 0.01})), 0.01 * instrument.first_order.depth_of_field);
}

// The third-order distortion of a lens, a shear, and a magnification that follows the focal plane, in their closed
// form.
TEST(PixelMapping, OfADistortedImageIsTheClosedForm) {
    constexpr double share = 0.0015, height = 0.3, shear = 0.1 * radians_per_degree, image_scale = 1.004;
    auto description = test::ideal_microscope(0.2);
    description.detector_width = 6;
    description.image = {.distortion = share, .field_height = height, .shear = shear, .magnification_rate = 0.1};
    const Instrument instrument = assemble(description);
    const PixelMapping mapping(description, instrument);
    EXPECT_EQ(instrument.magnification_rate, 0.1);
    const auto distorted = [&](glm::dvec2 place) {
        return place * (1 + share * glm::dot(place, place) / (height * height));
    };
    for (const glm::dvec2 nominal : somewhere(half_field(description, instrument), 12)) {
        const glm::dvec2 seen = distorted(mapping.place(nominal, image_scale));
        const glm::dvec2 recorded(seen.x + std::tan(shear) * seen.y, seen.y);
        EXPECT_LT(glm::distance(image_scale * recorded, nominal), nm);
    }
    // An affine fit over the field finds the shear less 2 d (<x^2> + <y^2>) of it, d the distortion by the squared
    // height, to first order in both: here <x^2> of 33 points along a side. The bound is the second order in d.
    const double side = half_field(description, instrument).x, mean_square = side * side * (16 * 17 / 3.0) / (16 * 16);
    const double coupled = 4 * share / (height * height) * mean_square;
    EXPECT_NEAR(mapping.deviation().perpendicularity, shear * (1 - coupled), 10 * coupled * coupled * shear);
    EXPECT_EQ(mapping.deviation().shift, glm::dvec2(0));

    // Over a disc of that height lengths are too long by two thirds of the distortion at its rim, and a third of it is
    // left there: 1.0e-3 and 0.15 um of 0.45 um.
    description.image.shear = 0;
    const PixelMapping unsheared(description, assemble(description));
    double products = 0, squares = 0;
    for (int k = 0; k < 4000; ++k) { // rings of equal area
        const double radius = height * std::sqrt((k + 0.5) / 4000);
        products += radius * distorted({radius, 0}).x;
        squares += radius * radius;
        EXPECT_NEAR(unsheared.place(distorted({radius, 0})).x, radius, nm);
    }
    EXPECT_NEAR(products / squares, 1.001, 1e-6);
    EXPECT_NEAR(distorted({height, 0}).x - height * products / squares, 0.15e-3, 1e-7);
}

// Nothing is aside in the middle, lengths are those of the magnification of rays, and a train that is all but
// symmetric, which is traced all over the field, agrees with the symmetric one.
TEST(PixelMapping, OfACentredInstrumentIsSymmetric) {
    auto description = test::microscope();
    const Instrument centred = assemble(description);
    const PixelMapping symmetric(description, centred);
    EXPECT_EQ(symmetric.deviation().shift, glm::dvec2(0));
    EXPECT_EQ(symmetric.deviation().rotation, 0);
    const double pitch = centred.first_order.pixel_pitch;
    const double magnification = image_quality(description, centred).magnification;
    EXPECT_NEAR(symmetric.deviation().amplification.x, magnification / centred.first_order.magnification, 1e-4);
    EXPECT_LT(symmetric.deviation().amplification.x, 0.999); // distortion separates it from the paraxial one
    description.detector_placement.change.tilt_x = 1e-5;
    const Instrument displaced = assemble(description);
    ASSERT_FALSE(imaging_of(displaced).symmetric);
    const PixelMapping general(description, displaced);
    for (const glm::dvec2 nominal : somewhere(half_field(description, centred), 12)) {
        EXPECT_LT(glm::distance(general.place(nominal), symmetric.place(nominal)), 1e-4 * pitch);
        EXPECT_NEAR(general.focus(nominal), symmetric.focus(nominal), 1e-2 * centred.first_order.depth_of_field);
        const glm::dvec2 turned = symmetric.place(-nominal);
        EXPECT_LT(glm::distance(-turned, symmetric.place(nominal)), 1e-6 * pitch);
    }
    EXPECT_LT(largest_miss(description, centred, symmetric), 0.002);
}

// A ball of glass with its stop in the middle focuses on a sphere about its centre, of its focal length as radius, and
// a lens that keeps the sine condition images light that leaves the sphere under the angle a at f' sin(a). So in focus
// pixels look where they nominally do, while in the plane through the middle's focus they look at f tan(a): there the
// field is distorted by 2 %.
TEST(PixelMapping, OfABallIsTakenWhereThePixelsAreInFocus) {
    constexpr double radius = 10, index = 1.5, focal_length = index * radius / (2 * (index - 1));
    auto description = test::ball_microscope(radius, index);
    description.detector_width = 57;
    const Instrument instrument = assemble(description);
    const PixelMapping mapping(description, instrument);
    const double pitch = instrument.first_order.pixel_pitch;
    double largest_distortion = 0;
    auto nominals = somewhere(half_field(description, instrument), 12);
    nominals.push_back(half_field(description, instrument));
    for (const glm::dvec2 nominal : nominals) {
        const double sine = glm::length(nominal) / focal_length;
        const double cosine = std::sqrt(1 - sine * sine);
        EXPECT_LT(glm::distance(mapping.place(nominal), nominal), 0.05 * pitch);
        EXPECT_NEAR(mapping.focus(nominal), focal_length * (1 - cosine), 0.004 * focal_length * (1 - cosine) + 1e-5);
        largest_distortion = std::max(largest_distortion, 1 / cosine - 1);
    }
    EXPECT_GT(largest_distortion, 0.02); // wrong twin: another plane
}

// Light that leaves the places that are told lands in the middle of the pixels, with parts decentred and tilted, a wide
// spectrum, folded and split ways.
TEST(PixelMapping, LeadsLightBackToThePixels) {
    const auto expect_back = [](const char* name, const InstrumentDescription& description, double least_aside) {
        const Instrument instrument = assemble(description);
        const PixelMapping mapping(description, instrument);
        EXPECT_LT(largest_miss(description, instrument, mapping), 0.01) << name;
        EXPECT_LT(mapping.deviation().error, 0.005 * instrument.first_order.pixel_pitch) << name;
        EXPECT_GT(largest_aside(description, instrument, mapping), least_aside) << name; // wrong twin: nominal places
    };
    auto decentred = test::microscope();
    decentred.objective_placement.change.decentre_x = 0.02;
    decentred.objective_placement.change.tilt_y = 0.05 * radians_per_degree;
    decentred.tube_lens_placement.change.decentre_y = -0.1;
    decentred.tube_lens_placement.change.tilt_x = 0.5 * radians_per_degree;
    decentred.detector_placement.change.tilt_y = 5 * radians_per_degree;
    decentred.detector_placement.change.decentre_x = 0.4;
    expect_back("decentred", decentred, 5);
    decentred.spectrum = Spectrum::gaussian(0.57, 0.03);
    expect_back("in white light", decentred, 5);
    auto folded = test::microscope();
    folded.splitter.kind = BeamSplitter::Kind::plate;
    folded.splitter.glass = Medium::constant("glass", 1.5);
    folded.splitter.size = 3;
    folded.objective_to_tube_lens = 150;
    folded.splitter.distance = 50;
    folded.fold_mirrors = {{.distance = 100, .incidence = 45 * radians_per_degree, .azimuth = 0, .semi_diameter = 20}};
    folded.detector_placement.change.decentre_y = -0.2;
    expect_back("folded", folded, 9);
    // A single lens behind a distant stop has barrel distortion.
    auto distorted = test::ideal_microscope(0.02);
    distorted.tube_lens = {};
    distorted.tube_lens.medium_before = Medium::air();
    distorted.tube_lens.surfaces = {test::prescribed(1 / 103.36, 8, Medium::constant("glass", 1.5168)),
                                    test::prescribed(0, 0, Medium::air())};
    distorted.detector_width = 50;
    const Instrument instrument = assemble(distorted);
    const PixelMapping mapping(distorted, instrument);
    const double corner = glm::length(half_field(distorted, instrument));
    const glm::dvec2 at(corner / std::sqrt(2.0), corner / std::sqrt(2.0));
    EXPECT_GT(std::abs(glm::length(mapping.place(at)) / corner - 1), 0.02);
    expect_back("distorted", distorted, 0.3);
    EXPECT_GT(mapping.deviation().residual, 0.1 * instrument.first_order.pixel_pitch);
}

// A detector turned in its plane gives a rotation, and its tilt a scale between the axes.
TEST(PixelMapping, TellsRotationAndAmplification) {
    auto description = test::ideal_microscope(0.2);
    constexpr double turn = 2 * radians_per_degree;
    description.detector_placement.change.tilt_z = turn;
    const Instrument turned = assemble(description);
    const PixelMapping mapping(description, turned);
    // Rows on the specimen have the direction of the detector's own x axis: both axes are inverted.
    const auto along = mapping.place({0.01, 0}) - mapping.place({-0.01, 0});
    EXPECT_NEAR(std::atan2(along.y, along.x), mapping.deviation().rotation, 1e-6);
    EXPECT_NEAR(std::abs(mapping.deviation().rotation), turn, 1e-6);
    EXPECT_NEAR(mapping.deviation().perpendicularity, 0, 1e-6);
    EXPECT_NEAR(mapping.deviation().amplification.x, 1, 1e-6);
    EXPECT_LT(largest_miss(description, turned, mapping), 1e-4);
    description.detector_placement.change.tilt_z = 0;
    description.detector_placement.change.tilt_y = 0.2; // rows are seen foreshortened
    const PixelMapping tilted(description, assemble(description));
    EXPECT_NEAR(tilted.deviation().amplification.x / tilted.deviation().amplification.y, 1 / std::cos(0.2), 1e-3);
}

// The rate is that of the places, by central differences.
TEST(PixelMapping, HasTheRateOfItsPlaces) {
    auto description = test::microscope();
    description.detector_placement.change.tilt_y = 0.1;
    description.detector_placement.change.decentre_y = 0.3;
    const double corner = glm::length(half_field(description, assemble(description)));
    description.image = {.distortion = -0.08, .field_height = corner, .shear = 0.1};
    const Instrument instrument = assemble(description);
    const PixelMapping mapping(description, instrument);
    constexpr double step = 1e-5;
    for (const glm::dvec2 nominal : somewhere(half_field(description, instrument), 5)) {
        for (const double scale : {1.0, 1.05}) {
            const glm::dmat2 rate = mapping.rate(nominal, scale);
            for (int axis = 0; axis < 2; ++axis) {
                const glm::dvec2 way = axis == 0 ? glm::dvec2(step, 0) : glm::dvec2(0, step);
                const glm::dvec2 expected =
                    (mapping.place(nominal + way, scale) - mapping.place(nominal - way, scale)) / (2 * step);
                EXPECT_LT(glm::distance(rate[axis], expected), 1e-8);
            }
        }
    }
}

} // namespace
} // namespace vkfv::optics
