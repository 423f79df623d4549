// The rectangle of directions that a source is aimed into holds all light which a single scatter brings to the
// detector.
#include "optics/aim/detector_aim.hpp"

#include "optics/parts.hpp"
#include "optics/prescriptions/ideal_lens.hpp"
#include "optics/train/train.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace vkfv::optics {
namespace {

using physics::f64::PATH_ALIVE;
using physics::f64::real2;
using physics::f64::real3;

struct Named {
    std::string name;
    InstrumentDescription description;
    double less = 0.85; // sides of the wrong twin; blur has margins
};

std::vector<Named> microscopes() {
    std::vector<Named> all;
    const auto add = [&](const std::string& name, InstrumentDescription description, double less = 0.85) {
        description.single_scatter = true;
        all.push_back({name, std::move(description), less});
    };
    const auto microscope = [] {
        auto description = test::microscope();
        description.greatest_defocus = 0.01;
        return description;
    };
    add("demo's", microscope());
    auto wide = microscope();
    wide.detector_width = 1.5;
    wide.detector_pixels = {.columns = 60, .rows = 30};
    wide.greatest_defocus = 0.03;
    add("wide detector, far out of focus", wide, 0.8);
    auto strip = microscope();
    strip.detector_width = 0.1;
    strip.detector_pixels = {.columns = 4, .rows = 64};
    strip.greatest_defocus = 0.06;
    add("upright strip, as far", strip, 0.6);
    auto rectangle = microscope();
    rectangle.source.rectangle = glm::dvec2(1.6, 0.7);
    add("source a rectangle", rectangle);
    auto overfilled = microscope(); // only the middle of the source fills the pupil
    overfilled.source.radius = 6;
    overfilled.greatest_defocus = 0.03;
    add("source too large", overfilled, 0.6);
    overfilled.source.radius = 15;
    add("source far too large", overfilled, 0.5);
    auto coloured = microscope();
    coloured.spectrum = Spectrum::lines({0.486, 0.5876, 0.656}, {1, 1, 1});
    add("white light", coloured, 0.8);
    auto field = microscope(); // to its corners, where it is distorted and curved
    field.field_stop_radius = 8;
    field.detector_width = 9;
    add("whole field", field);
    auto large = test::ideal_microscope(0.28);
    large.greatest_defocus = 0.02;
    add("ideal lenses", large);
    auto steep = test::ideal_microscope(0.5);
    steep.source.radius = 1.7;
    steep.greatest_defocus = 0.004;
    add("aperture of 0.5", steep);
    return all;
}

// The distances, from the middle of the aim and along both of its sides, at which light leaves the source that meets
// the detector after one scatter at some height: in half sides of the aim's rectangle.
std::vector<glm::dvec2> seen_directions(const Instrument& instrument, double greatest_height) {
    const auto& constants = instrument.constants;
    const glm::dvec2 sides = instrument.single_scatter_aim.value();
    const std::span<const physics::f64::Surface> imaging =
        std::span(instrument.surfaces)
            .subspan(std::size_t(constants.imaging_first), std::size_t(constants.imaging_count));
    std::mt19937_64 generator(5);
    std::uniform_real_distribution<double> uniform(0, 1);
    const physics::f64::SpecimenRecord plane{};
    std::vector<glm::dvec2> seen;
    constexpr std::uint32_t rays = 300000;
    for (std::uint32_t k = 0; k < rays; ++k) {
        // Heights are mostly at both ends, which decide.
        const double height = greatest_height * std::clamp(3 * uniform(generator) - 1.5, -1.0, 1.0);
        const auto exposure = test::exposure_of(instrument.front_vertex_height - height, 43);
        const auto emission = physics::f64::emit(instrument.scene(), constants,
                                                 physics::f64::draw(exposure.seed, exposure.image, {k, 0}, 0u));
        const auto arrival = physics::f64::illuminate(instrument.scene(), constants, plane, exposure, emission);
        if (arrival.fate.status != PATH_ALIVE) {
            continue;
        }
        const auto gate = physics::f64::gate_disc(constants, 0, arrival.position);
        const real3 scattered = physics::f64::direction_in_disc(gate, uniform(generator), uniform(generator));
        physics::f64::Ray ray{};
        ray.position = real3(arrival.position.x, arrival.position.y, -exposure.top_distance);
        ray.direction = scattered;
        const auto landed = trace_through(imaging, ray, 1, emission.light.spectral);
        const auto end = physics::f64::fly_to_plane(landed.ray, constants.detector_distance, landed.index);
        if (landed.status == PATH_ALIVE && std::abs(end.position.x) < constants.detector_half_width &&
            std::abs(end.position.y) < constants.detector_half_height) {
            const glm::dvec2 middle = constants.emission_shift * glm::dvec2(emission.ray.position);
            seen.push_back(glm::abs(glm::dvec2(emission.ray.direction) - middle) / sides);
        }
    }
    return seen;
}

TEST(DetectorAim, HoldsAllThatTheDetectorSees) {
    for (const auto& [name, description, less] : microscopes()) {
        SCOPED_TRACE(name);
        const Instrument instrument = assemble(description);
        ASSERT_TRUE(instrument.single_scatter_aim);
        const auto seen = seen_directions(instrument, description.greatest_defocus);
        EXPECT_GT(seen.size(), 400u);
        glm::dvec2 farthest(0);
        int lost_by_narrower = 0; // wrong twins: less of either side
        int lost_by_lower = 0;
        for (const glm::dvec2& direction : seen) {
            farthest = glm::max(farthest, direction);
            lost_by_narrower += direction.x > less;
            lost_by_lower += direction.y > less;
        }
        EXPECT_LE(farthest.x, 1);
        EXPECT_LE(farthest.y, 1);
        EXPECT_GT(lost_by_narrower, 0);
        EXPECT_GT(lost_by_lower, 0);
        const Instrument aimed = aimed_for_single_scatter(instrument);
        EXPECT_LT(aimed.aimed_share(), 0.98 * instrument.aimed_share());
    }
}

// The light that is emitted into the rectangle is uniform in it, and no more than asked for.
TEST(DetectorAim, IsWhatTheSourceEmitsInto) {
    auto description = test::microscope();
    description.detector_pixels = {.columns = 64, .rows = 32};
    description.greatest_defocus = 0.01;
    description.single_scatter = true;
    const Instrument instrument = aimed_for_single_scatter(assemble(description));
    const auto& constants = instrument.constants;
    const glm::dvec2 sides = instrument.single_scatter_aim.value();
    EXPECT_EQ(constants.emission_sine, glm::length(sides));
    EXPECT_NEAR(instrument.aimed_share(), 4 * sides.x * sides.y / M_PI, 1e-15);
    std::vector<glm::dvec2> emitted; // in half sides of the rectangle
    constexpr int rays = 100000;
    for (std::uint32_t k = 0; k < rays; ++k) {
        const auto ray = physics::f64::emit(instrument.scene(), constants, physics::f64::draw(7, 0, {k, 0}, 0u)).ray;
        EXPECT_NEAR(glm::length(ray.direction), 1, 1e-15);
        EXPECT_LE(glm::length(glm::dvec2(ray.position)), description.source.radius);
        const glm::dvec2 beside =
            (glm::dvec2(ray.direction) - constants.emission_shift * glm::dvec2(ray.position)) / sides;
        EXPECT_LE(std::max(std::abs(beside.x), std::abs(beside.y)), 1 + 1e-12);
        emitted.push_back(beside);
    }
    // The number of standard deviations by which mean and variance along either side are off, for a rectangle of other
    // sides.
    const auto off = [&](glm::dvec2 narrower, glm::dvec2 aside) {
        glm::dvec2 sum(0), squares(0);
        for (const glm::dvec2& each : emitted) {
            const glm::dvec2 place = each / narrower - aside;
            sum += place;
            squares += place * place;
        }
        const glm::dvec2 mean = glm::abs(sum) / std::sqrt(rays / 3.0);
        const glm::dvec2 variance = glm::abs(squares - rays / 3.0) / std::sqrt(rays * 4 / 45.0);
        return std::max({mean.x, mean.y, variance.x, variance.y});
    };
    EXPECT_LT(off({1, 1}, {0, 0}), 4);
    // The wrong twins have a side two hundredths shorter, or a middle two hundredths beside its own; one standard
    // deviation of so many rays is 0.0018 of a half side for the mean, 0.3 % for the variance.
    EXPECT_GT(off({0.98, 1}, {0, 0}), 4);
    EXPECT_GT(off({1, 0.98}, {0, 0}), 4);
    EXPECT_GT(off({1, 1}, {0.02, 0}), 4);
    EXPECT_GT(off({1, 1}, {0, 0.02}), 4);
}

// In these cases the aim stays a disc.
TEST(DetectorAim, IsLeftOutWhereItSavesNothingOrIsNotKnown) {
    const auto aim_of = [](InstrumentDescription description) {
        description.single_scatter = true;
        description.greatest_defocus = std::min(description.greatest_defocus, 0.01);
        return assemble(description).single_scatter_aim;
    };
    auto small = test::microscope();
    small.field_stop_radius = 0.3;
    EXPECT_FALSE(aim_of(small));
    auto analog = test::microscope();
    analog.directed_emission = false;
    EXPECT_FALSE(aim_of(analog));
    auto tilted = test::microscope();
    tilted.detector_placement.change.tilt_x = 0.1;
    EXPECT_FALSE(aim_of(tilted));
    auto ring = test::ideal_microscope(0.28);
    ring.source.ring = RingLightDescription{
        .distance = 12, .elevation = 0.5, .width = 2, .segments = 1, .fill = 1, .on = {true}, .lit_radius = 0.3};
    EXPECT_FALSE(aim_of(ring));
    auto far = test::microscope();
    far.single_scatter = true;
    far.greatest_defocus = 0.2;
    EXPECT_FALSE(assemble(far).single_scatter_aim);
    EXPECT_TRUE(aim_of(test::microscope()));
    EXPECT_FALSE(assemble(test::microscope()).single_scatter_aim); // not asked for
}

} // namespace
} // namespace vkfv::optics
