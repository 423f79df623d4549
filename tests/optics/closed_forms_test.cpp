// Parts that are decentred, tilted or put between others move light as closed forms say, alone and in whole
// instruments.
#include "core/mathematics/units.hpp"
#include "core/messages/error.hpp"
#include "optics/instrument/instrument.hpp"
#include "parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>

namespace vkfv::optics {
namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::Ray;
using ::testing::HasSubstr;

constexpr double n = 1.5168; // N-BK7 at d

std::vector<physics::f64::Surface> linked(const Prescription& prescription) {
    Pose end;
    auto part = place_prescription(prescription, Spectrum::line(test::d_line_um), {}, Pose{}, end);
    part.push_back(dummy_plane({}, Pose{}, "entry's frame")); // results in the frame of the first vertex
    link(part, Pose{});
    return surfaces_of(part);
}

// A biconvex lens of vanishing thickness, displaced by `change`.
Prescription thin_lens(const CoordinateBreak& change) {
    Prescription lens;
    lens.medium_before = Medium::air();
    lens.surfaces = {test::prescribed(1 / 60.0, 0, Medium::constant("N-BK7", n), {change}),
                     test::prescribed(-1 / 90.0, 0, Medium::air())};
    return lens;
}
const double focal_length = 1 / ((n - 1) * (1 / 60.0 + 1 / 90.0));

Prescription plate(double thickness, const CoordinateBreak& change) {
    Prescription prescription;
    prescription.medium_before = Medium::air();
    prescription.surfaces = {test::prescribed(0, thickness, Medium::constant("N-BK7", n), {change}),
                             test::prescribed(0, 0, Medium::air())};
    return prescription;
}

// The point where a ray crosses the plane z in the frame of the first vertex.
glm::dvec3 at(const Ray& ray, double z) {
    return ray.position + ray.direction * ((z - ray.position.z) / ray.direction.z);
}

// Aberrations grow with the cube of decentre and height over the square of the focal length, here 1e-9 mm and a few.
constexpr double decentre = 1e-2;

TEST(DecentredThinLens, TakesTheImageOfInfinityAlong) {
    const auto train = linked(thin_lens({.decentre_x = decentre, .decentre_y = -0.5 * decentre}));
    for (const double height : {-0.01, 0.0, 0.01}) {
        const auto image = at(test::trace(train, {height, 0, -5}, {0, 0, 1}).ray, focal_length);
        EXPECT_NEAR(image.x, decentre, 5e-9);
        EXPECT_NEAR(image.y, -0.5 * decentre, 5e-9);
    }
}

// The object is at -d from the lens' axis, its image at -m d.
TEST(DecentredThinLens, MovesTheImageOfAPointByOneMinusMagnification) {
    const auto train = linked(thin_lens({.decentre_x = decentre}));
    for (const double object_distance : {100.0, 200.0}) {
        const double image_distance = 1 / (1 / focal_length - 1 / object_distance);
        const double magnification = -image_distance / object_distance;
        for (const double slope : {-1e-4, 0.0, 1e-4}) {
            const auto image = at(test::trace(train, {0, 0, -object_distance}, {slope, 0, 1}).ray, image_distance);
            EXPECT_NEAR(image.x, decentre * (1 - magnification), 1e-8);
            EXPECT_GT(std::abs(image.x - decentre * (-magnification)), 1e-3); // wrong twin
        }
    }
}

// A tilted thin lens leaves the ray through its vertex and has two focal lines (Coddington's equations with the stop at
// the lens): sagittal power (n cos' - cos) (c1 - c2), tangential that over cos^2.
TEST(TiltedThinLens, HasCoddingtonsFocalLines) {
    const double tilt = 0.3;
    const auto train = linked(thin_lens({.tilt_x = tilt}));
    const double inside = std::asin(std::sin(tilt) / n);
    const double sagittal = (n * std::cos(inside) - std::cos(tilt)) * (1 / 60.0 + 1 / 90.0);
    const auto vertex = test::trace(train, {0, 0, -5}, {0, 0, 1});
    EXPECT_NEAR(vertex.ray.direction.x, 0, 1e-15);
    EXPECT_NEAR(vertex.ray.direction.y, 0, 1e-15);
    constexpr double height = 1e-3; // coma, of its square, cancels between two sides
    const auto power = [&](glm::dvec3 side) {
        const auto above = test::trace(train, side * height + glm::dvec3(0, 0, -5), {0, 0, 1}).ray;
        const auto below = test::trace(train, -side * height + glm::dvec3(0, 0, -5), {0, 0, 1}).ray;
        return -glm::dot(above.direction - below.direction, side) / (2 * height);
    };
    EXPECT_NEAR(power({1, 0, 0}) / sagittal, 1, 1e-8);
    EXPECT_NEAR(power({0, 1, 0}) / sagittal * std::pow(std::cos(tilt), 2), 1, 1e-8);
    EXPECT_GT(std::abs(power({1, 0, 0}) * focal_length - 1), 0.01); // wrong twin: untilted
}

// A tilted plate displaces a ray by t sin(theta) (1 - cos(theta) / (n cos(theta'))), towards where its far face leans.
TEST(TiltedPlate, DisplacesARay) {
    for (const double theta : {0.1, 0.5, 0.785398}) {
        const double inside = std::asin(std::sin(theta) / n);
        const double expected = 3 * std::sin(theta) * (1 - std::cos(theta) / (n * std::cos(inside)));
        for (const double shift : {0.0, 1.7}) { // a decentre does nothing
            const auto train = linked(plate(3, {.decentre_x = shift, .decentre_y = -shift, .tilt_x = theta}));
            const auto result = test::trace(train, {0.2, 0.1, -5}, {0, 0, 1});
            EXPECT_NEAR(result.ray.position.x, 0.2, 1e-14);
            EXPECT_NEAR(result.ray.position.y, 0.1 - expected, 1e-14); // z turns towards -y
            EXPECT_NEAR(result.ray.direction.z, 1, 1e-15);
        }
        const auto about_y = linked(plate(3, {.tilt_y = theta}));
        EXPECT_NEAR(test::trace(about_y, {0, 0, -5}, {0, 0, 1}).ray.position.x, expected, 1e-14);
        EXPECT_GT(std::abs(expected - 3 * (n - 1) / n * theta), 1e-5); // wrong twin: small angles
    }
}

// A cover plate of 0.17 mm moves the marginal focus by 0.17 (1 - tan(asin(NA / n)) / tan(asin NA)) mm.
TEST(CoverPlate, MovesTheMarginalFocus) {
    const auto train = linked(plate(0.17, {}));
    const auto shift = [&](double na) {
        const double slope = na / std::sqrt(1 - na * na);
        // The cone converges to the axis 10 mm behind the first face.
        const auto result = test::trace(train, {10 * slope, 0, 0}, {-slope, 0, 1});
        return result.ray.position.x / slope - 10 + result.ray.position.z;
    };
    for (const double na : {0.1, 0.28, 0.4, 0.8}) {
        const double expected = 0.17 * (1 - std::tan(std::asin(na / n)) / std::tan(std::asin(na)));
        EXPECT_NEAR(shift(na), expected, 1e-13);
    }
    EXPECT_NEAR(shift(0.4), 63.5e-3, 5e-5);                     // its value, by hand
    EXPECT_GT(std::abs(shift(0.4) - 0.17 * (1 - 1 / n)), 4e-3); // wrong twin: paraxial
}

// The objective's height over the specimen, from the room's elements.
double objective_height(const Instrument& instrument) {
    for (const Element& element : instrument.elements) {
        if (element.part == Part::objective) {
            return element.pose.origin.z + instrument.first_order.best_focus_offset;
        }
    }
    return 0;
}

TEST(CoverGlass, MovesTheObjectiveByItsReducedThickness) {
    auto description = test::microscope();
    const auto without = assemble(description);
    EXPECT_NEAR(objective_height(without), without.first_order.working_distance, 1e-12);
    description.cover_glass = CoverGlass{.thickness = 0.17, .glass = Medium::constant("N-BK7", n), .distance = 2.0};
    const auto with = assemble(description);
    EXPECT_NEAR(objective_height(with) - objective_height(without), 0.17 * (1 - 1 / n), 1e-12);
    EXPECT_NEAR(with.first_order.working_distance, 2, 1e-15); // now the plate's lower face
    EXPECT_NEAR(with.first_order.magnification, without.first_order.magnification, 1e-12);
    // A paraxial ray from the object's axis still meets the detector's.
    const auto traced = test::trace({with.surfaces.begin() + with.constants.imaging_first, with.surfaces.end()},
                                    {0, 0, -2}, {1e-5, 0, 1});
    const auto landed = physics::f64::fly_to_plane(traced.ray, with.constants.detector_distance, 1);
    EXPECT_NEAR(landed.position.x, 0, 1e-9);
    // The plate over-corrects the margin: best focus moves down against the paraxial one by as much as the plate moves
    // the cone's rays.
    const double na = with.first_order.numerical_aperture;
    const double marginal = 0.17 * (1 - std::tan(std::asin(na / n)) / std::tan(std::asin(na)) - (1 - 1 / n));
    const double moved = with.first_order.best_focus_offset - without.first_order.best_focus_offset;
    EXPECT_LT(moved, 0);
    EXPECT_GT(moved, -marginal);
}

// The landing of a ray from the object's axis with a small slope, less that of the undisturbed instrument.
glm::dvec2 landing(const Instrument& instrument, double slope = 0) {
    const std::vector<physics::f64::Surface> train(instrument.surfaces.begin() + instrument.constants.imaging_first,
                                                   instrument.surfaces.end());
    const auto result = test::trace(train, {0, 0, -instrument.first_order.working_distance}, {slope, 0, 1});
    EXPECT_EQ(result.status, PATH_ALIVE);
    const auto landed = physics::f64::fly_to_plane(result.ray, instrument.constants.detector_distance, 1);
    return {landed.position.x, landed.position.y};
}

Instrument displaced(const std::function<void(InstrumentDescription&)>& change) {
    auto description = test::microscope();
    change(description);
    return assemble(description);
}

RingLightDescription any_ring(double distance) {
    return {
        .distance = distance, .elevation = 0.5, .width = 1, .segments = 1, .fill = 1, .on = {true}, .lit_radius = 0.1};
}

// Ideal lenses of the same focal lengths have no aberration, so decentres and tilts may be large.
constexpr double objective_focal_length = 20;
constexpr double tube_focal_length = 200;
constexpr double tube_distance = 100;

Instrument ideal(const std::function<void(InstrumentDescription&)>& change) {
    const auto lens = [](double f) {
        auto surface = test::prescribed(0, 0, Medium::air());
        surface.ideal_power = 1 / f;
        return surface;
    };
    auto description = test::microscope();
    auto stop = test::prescribed(0, 0, Medium::air());
    stop.semi_diameter = objective_focal_length * 0.28;
    stop.role = PrescribedSurface::Role::aperture_stop;
    description.objective.surfaces = {lens(objective_focal_length), stop};
    description.objective.surfaces.front().thickness = objective_focal_length;
    description.tube_lens.surfaces = {lens(tube_focal_length)};
    description.objective_to_tube_lens = tube_distance;
    description.source.ring = any_ring(30); // the disc's illuminator is for the tests that ask for it
    description.source.radius = 1;
    change(description);
    return assemble(description);
}

TEST(IdealInstrument, HasItsFirstOrder) {
    const auto instrument = ideal([](auto&) {});
    EXPECT_TRUE(instrument.features & physics::f64::FEATURE_IDEAL_LENS);
    EXPECT_NEAR(instrument.first_order.working_distance, objective_focal_length, 1e-12);
    EXPECT_NEAR(instrument.constants.detector_distance, tube_focal_length, 1e-12);
    EXPECT_NEAR(instrument.first_order.magnification, -10, 1e-12);
    EXPECT_NEAR(instrument.first_order.numerical_aperture, 0.28, 1e-9);
    EXPECT_NEAR(instrument.first_order.best_focus_offset, 0, 1e-9);
    for (const double slope : {-0.25, 0.0, 0.2}) {
        EXPECT_LT(glm::length(landing(instrument, slope)), 1e-12);
    }
}

// In the infinity space a tube lens takes the image along; the objective moves it by minus the magnification times its
// own decentre; a decentred detector sees it the other way.
TEST(DecentredParts, MoveTheImage) {
    const double far = 0.7;
    const auto tube = ideal([&](auto& d) { d.tube_lens_placement.change.decentre_x = far; });
    EXPECT_TRUE(tube.features & physics::f64::FEATURE_PLACEMENT);
    const auto objective = ideal([&](auto& d) { d.objective_placement.change.decentre_y = far; });
    const auto detector = ideal([&](auto& d) { d.detector_placement.change.decentre_x = far; });
    for (const double slope : {-0.1, 0.0, 0.2}) {
        EXPECT_LT(glm::length(landing(tube, slope) - glm::dvec2(far, 0)), 1e-12);
        EXPECT_LT(glm::length(landing(objective, slope) - glm::dvec2(0, 10 * far)), 1e-11);
        EXPECT_LT(glm::length(landing(detector, slope) - glm::dvec2(-far, 0)), 1e-12);
    }
}

// An ideal lens tilted by t takes a ray through its vertex, which leans by t against its axis, from the height f tan(t)
// in its front focal plane to the sine tan(t) behind: it turns it by asin(tan t) - t, of the third order.
TEST(TiltedParts, TurnTheRayThroughTheVertexByTheThirdOrder) {
    const double tilt = 0.05;
    const double turn = std::asin(std::tan(tilt)) - tilt;
    const auto objective = ideal([&](auto& d) { d.objective_placement.change.tilt_y = tilt; });
    EXPECT_NEAR(landing(objective).x, -tube_focal_length * std::sin(turn), 1e-11);
    // The tilted lens' back focal plane is crossed at f sin(t) (1 - cos t), f cos(t) (1 - cos t) behind the detector.
    const auto tube = ideal([&](auto& d) { d.tube_lens_placement.change.tilt_y = tilt; });
    const double expected =
        tube_focal_length * (1 - std::cos(tilt)) * (std::sin(tilt) + std::cos(tilt) * std::tan(turn));
    EXPECT_NEAR(landing(tube).x, expected, 1e-11);
    EXPECT_NEAR(expected, 0.5 * tube_focal_length * std::pow(tilt, 3), 1e-4);
    EXPECT_GT(std::abs(landing(ideal([](auto&) {})).x - expected), 1e-3); // wrong twin: untilted
}

// The nodal point of a real tube lens moves, seen from the vertex that the tilt is about, and takes the image along.
TEST(TiltedParts, MoveTheImageWithTheNodalPoint) {
    const auto straight = assemble(test::microscope());
    const double tilt = 1e-3;
    const auto tilted = displaced([&](auto& d) {
        d.tube_lens_placement.change.tilt_y = tilt;
        d.source.ring = any_ring(30);
    });
    double first = 0;
    double last = 0;
    for (const Element& element : straight.elements) {
        if (element.part == Part::tube_lens) {
            first = first == 0 ? element.pose.origin.z : first;
            last = element.pose.origin.z;
        }
    }
    const double nodal_point = last - first + straight.constants.detector_distance - straight.first_order.efl_tube_lens;
    EXPECT_GT(std::abs(nodal_point), 5);
    // The tolerance is of second order in the tilt.
    EXPECT_NEAR(landing(tilted).x / (nodal_point * tilt), 1, 5e-3);
    EXPECT_NEAR(landing(tilted).y, 0, 1e-12);
}

// A decentre of the tube lens moves the image of real lenses as that of ideal ones.
TEST(DecentredParts, MoveTheImageOfRealLenses) {
    const auto tube = displaced([](auto& d) {
        d.tube_lens_placement.change.decentre_x = decentre;
        d.source.ring = any_ring(30);
    });
    for (const double slope : {-1e-4, 0.0, 1e-4}) {
        EXPECT_NEAR(landing(tube, slope).x, decentre, 1e-8);
        EXPECT_NEAR(landing(tube, slope).y, 0, 1e-14);
    }
}

TEST(DecentredParts, StandGloballyAsLocally) {
    const CoordinateBreak change{.decentre_x = 0.3, .decentre_y = -0.2, .tilt_x = 0.2, .tilt_y = 0.1};
    const auto local = ideal([&](auto& d) { d.tube_lens_placement.change = change; });
    const auto global = ideal([&](auto& d) {
        d.tube_lens_placement.change = {.tilt_x = 0.2, .tilt_y = 0.1};
        // The height over the object plane is a focal length to the lens, another one to its stop, and the distance to
        // the tube lens.
        d.tube_lens_placement.global = glm::dvec3(0.3, -0.2, 2 * objective_focal_length + tube_distance);
    });
    const auto straight = ideal([](auto&) {});
    ASSERT_EQ(local.surfaces.size(), global.surfaces.size());
    for (const double slope : {-0.1, 0.0, 0.05}) {
        EXPECT_LT(glm::length(landing(local, slope) - landing(global, slope)), 1e-11);
        EXPECT_GT(glm::length(landing(local, slope) - landing(straight, slope)), 0.1); // wrong twin
    }
}

// A break within the prescription moves the lens, not the detector and not the specimen.
TEST(DecentredParts, MayBePrescribed) {
    const CoordinateBreak change{.decentre_x = 0.3, .decentre_y = -0.2, .tilt_x = 0.2, .tilt_y = 0.1};
    const auto placed = ideal([&](auto& d) { d.tube_lens_placement.change = change; });
    const auto prescribed = ideal([&](auto& d) { d.tube_lens.surfaces.front().breaks = {change}; });
    for (const double slope : {-0.1, 0.0, 0.05}) {
        EXPECT_LT(glm::length(landing(placed, slope) - landing(prescribed, slope)), 1e-11);
    }
    const CoordinateBreak decentred{.decentre_x = 0.3, .decentre_y = -0.2};
    const auto with_disc = [](const CoordinateBreak& place, const CoordinateBreak& prescription) {
        return ideal([&](auto& d) {
            d.source.ring.reset();
            d.objective_placement.change = place;
            d.objective.surfaces.front().breaks = {prescription};
        });
    };
    const auto objective_placed = with_disc(decentred, {});
    const auto objective_prescribed = with_disc({}, decentred);
    const auto lit = [](const Instrument& instrument) {
        const std::vector<physics::f64::Surface> train(
            instrument.surfaces.begin(), instrument.surfaces.begin() + instrument.constants.illumination_count);
        const auto result = test::trace(train, {0.1, 0.2, -instrument.constants.source_distance}, {0.01, 0, 1});
        EXPECT_EQ(result.status, PATH_ALIVE);
        const auto down = physics::f64::fly_to_plane(result.ray, instrument.first_order.working_distance, 1);
        return glm::dvec2(down.position.x, down.position.y);
    };
    EXPECT_LT(glm::length(lit(objective_placed) - lit(objective_prescribed)), 1e-11);
    // The lit spot goes with the objective; y of the illumination is -y of the specimen.
    EXPECT_LT(glm::length(lit(objective_placed) - lit(with_disc({}, {})) - glm::dvec2(0.3, 0.2)), 1e-11);
}

// A plate or a cube in the infinity space displaces the beam, not the image; the plate tilts no ray.
TEST(BeamSplitter, LeavesTheImage) {
    for (const auto kind : {BeamSplitter::Kind::plate, BeamSplitter::Kind::cube}) {
        const auto instrument = ideal([&](auto& d) {
            d.splitter.kind = kind;
            d.splitter.glass = Medium::constant("N-BK7", n);
            d.splitter.size = kind == BeamSplitter::Kind::plate ? 2 : 20;
        });
        for (const double slope : {-0.1, 0.0, 0.2}) {
            EXPECT_LT(glm::length(landing(instrument, slope)), 1e-11);
        }
    }
}

// The source is aimed at the field stop with a stop at the source as without: here at a pinhole, which a search about
// the wrong direction misses.
TEST(IlluminationAperture, LeavesTheAim) {
    const auto pinhole = [](std::optional<double> aperture) {
        return ideal([&](auto& d) {
            d.source.ring.reset();
            d.field_stop_radius = 0.01;
            d.illumination_aperture_radius = aperture;
        });
    };
    const auto open = pinhole({}).constants;
    const auto wide = pinhole(2.0).constants;
    const auto narrow = pinhole(0.3).constants;
    // The source has a radius of 1 mm: a cone about the normal would be ten times as wide.
    EXPECT_GT(std::abs(open.emission_shift) * open.source_radius, 10 * open.emission_sine);
    EXPECT_NEAR(wide.emission_sine, open.emission_sine, 1e-6);
    EXPECT_NEAR(wide.emission_shift, open.emission_shift, 1e-6);
    // From the middle of the source the pinhole is seen under its radius over the condenser's focal length, 26.0 mm,
    // and the aim is 1.02 times as wide; aberrations, which grow with the cube of the place, are left by the narrow
    // stop.
    const double pinhole_sine = 1.02 * 0.01 / 26.0;
    EXPECT_NEAR(narrow.emission_sine, pinhole_sine, 0.015 * pinhole_sine);
    EXPECT_NEAR(narrow.emission_shift, open.emission_shift, 0.05 * std::abs(open.emission_shift));
    EXPECT_GT(open.emission_sine, 1.1 * pinhole_sine); // aberrations of all of the source
}

TEST(RingLight, StandsAboveTheCoverGlass) {
    const auto assembled = [](double distance) {
        return ideal([&](auto& d) {
            d.source.ring = any_ring(distance);
            d.cover_glass = CoverGlass{.thickness = 0.17, .glass = Medium::constant("N-BK7", n), .distance = 5.0};
        });
    };
    EXPECT_EQ(assembled(30).constants.illumination_count, 2);
    try {
        assembled(10);
        ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
        EXPECT_THAT(error.problem().expected, HasSubstr("above the cover glass"));
    }
}

} // namespace
} // namespace vkfv::optics
