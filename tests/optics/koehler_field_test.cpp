// Köhler's illumination through the 20x objective fills the field uniformly.
#include "core/mathematics/units.hpp"
#include "parts.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vkfv::optics {
namespace {

using physics::f64::PATH_ALIVE;

constexpr double field_stop_radius = 0.85;                                     // mm
constexpr double lit_radius = field_stop_radius * 10.000000444 / 149.97575906; // its image on the specimen
constexpr double field_radius = 0.85 * lit_radius;                             // inside the blur of the stop's image
constexpr double false_positive_rate = 1e-4;

InstrumentDescription koehler_20x() {
    auto description = test::microscope("20x_0.41");
    description.field_stop_radius = field_stop_radius;
    return description;
}

// The counts of light that arrives in cells of equal area: rings about the axis, cut into sectors.
std::vector<double> arrivals(const Instrument& instrument, std::uint32_t paths) {
    constexpr int rings = 10;
    constexpr int sectors = 8;
    physics::f64::SpecimenRecord specimen{};
    const auto exposure = test::exposure_of(instrument.front_vertex_height, 41);
    std::vector<double> cells(rings * sectors);
    for (std::uint32_t k = 0; k < paths; ++k) {
        const auto emission = physics::f64::emit(instrument.scene(), instrument.constants,
                                                 physics::f64::draw(exposure.seed, exposure.image, {k, 0}, 0u));
        const auto arrival =
            physics::f64::illuminate(instrument.scene(), instrument.constants, specimen, exposure, emission);
        const auto& p = arrival.position;
        const double share = (p.x * p.x + p.y * p.y) / (field_radius * field_radius);
        if (arrival.fate.status == PATH_ALIVE && share < 1) {
            const int ring = static_cast<int>(rings * share);
            const int sector = static_cast<int>(sectors * (0.5 + 0.5 * std::atan2(p.y, p.x) / pi)) % sectors;
            cells[static_cast<std::size_t>(ring * sectors + sector)] += 1;
        }
    }
    return cells;
}

// The p-value of the counts for an irradiance that falls off by `fall` to the rim, with the square of the radius.
double p_of(const std::vector<double>& cells, double fall) {
    std::vector<double> expected;
    double sum = 0;
    double seen = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        expected.push_back(1 - fall * (static_cast<double>(i / 8) + 0.5) / 10);
        sum += expected.back();
        seen += cells[i];
    }
    for (double& value : expected) {
        value *= seen / sum;
    }
    return test::chi_square_p(cells, expected);
}

// The irradiance at a point of the specimen over the radiance: the area, in direction cosines, of the light that leads
// back to the source. Radiance is the same all along a ray, so this needs no sampling of the source.
double irradiance(const Instrument& instrument, double source_radius, double x) {
    const auto& constants = instrument.constants;
    std::vector<physics::f64::Surface> backward;
    for (int i = constants.illumination_count - 1; i >= 0; --i) {
        physics::f64::Surface surface = instrument.surfaces[static_cast<std::size_t>(i)];
        surface.curvature = -surface.curvature;
        surface.a4 = -surface.a4; // the condenser has no other
        surface.distance =
            i + 1 < constants.illumination_count ? instrument.surfaces[static_cast<std::size_t>(i) + 1].distance : 0;
        std::swap(surface.index_before, surface.index_after);
        backward.push_back(surface);
    }
    const auto comes_from_source = [&](double l, double m) {
        const auto result =
            test::trace(backward, {x, 0, -instrument.front_vertex_height}, {l, m, std::sqrt(1 - l * l - m * m)}, 1u);
        const auto at_source = physics::f64::fly_to_plane(result.ray, constants.source_distance, 1);
        return result.status == PATH_ALIVE && std::hypot(at_source.position.x, at_source.position.y) < source_radius;
    };
    constexpr int azimuths = 64;
    double area = 0;
    for (int i = 0; i < azimuths; ++i) {
        const double azimuth = 2 * pi * (i + 0.5) / azimuths;
        double inside = 0;
        double outside = 0.9;
        for (int step = 0; step < 40; ++step) {
            const double middle = 0.5 * (inside + outside);
            (comes_from_source(middle * std::cos(azimuth), middle * std::sin(azimuth)) ? inside : outside) = middle;
        }
        area += 0.5 * inside * inside * 2 * pi / azimuths;
    }
    return area;
}

TEST(KoehlerField, IsUniformWithinTheStatisticalError) {
    const auto cells = arrivals(assemble(koehler_20x()), 200000);
    double seen = 0;
    for (const double cell : cells) {
        seen += cell;
    }
    EXPECT_GT(seen, 50000);
    EXPECT_GT(p_of(cells, 0), false_positive_rate);
    EXPECT_LT(p_of(cells, 0.15), false_positive_rate); // wrong twin: less light at the rim
}

// The irradiance of the real lenses varies over the field by the pupil's aberrations alone.
TEST(KoehlerField, IsUniformByTheRadianceThatReachesIt) {
    const auto description = koehler_20x();
    const auto instrument = assemble(description);
    const double middle = irradiance(instrument, description.source.radius, 0);
    // The objective's numerical aperture is filled: pi NA^2. The imaging's cone starts a best focus offset away, and
    // its pupil is seen the other way through: they differ by its aberration.
    EXPECT_NEAR(middle / (pi * std::pow(instrument.first_order.numerical_aperture, 2)), 1, 2e-3);
    for (const double share : {0.35, 0.7, 1.0}) {
        // The tolerance is less than the statistics of any image could show.
        EXPECT_NEAR(irradiance(instrument, description.source.radius, share * field_radius) / middle, 1, 1e-4) << share;
    }
    // Wrong twin: a source that does not fill the pupil lights less.
    EXPECT_LT(irradiance(instrument, 0.6, 0) / middle, 0.8);
}

// The lenses are Fourier lenses one after another (physics/ideal_lens.glsl): light from s at the source in the
// direction u crosses the field stop at f_condenser u, the pupil at -(f_field / f_condenser) s, and meets the specimen
// at the stop's image.
TEST(KoehlerField, IdealLensesMapPlacesToDirectionsAndBack) {
    constexpr double condenser = 30, field_lens = 120, objective = 20, aperture = 0.3;
    auto description = test::ideal_microscope(aperture);
    description.illumination = ideal_koehler(condenser, field_lens);
    description.field_stop_radius = 0.6;
    description.source.radius = 1.2 * objective * aperture * condenser / field_lens;
    const auto instrument = assemble(description);
    EXPECT_NEAR(instrument.first_order.pupil_radius_in_source, objective * aperture * condenser / field_lens, 1e-9);
    EXPECT_NEAR(instrument.first_order.source_magnification, -field_lens / condenser, 1e-9);
    EXPECT_NEAR(std::abs(instrument.first_order.field_stop_magnification), objective / field_lens, 1e-9);
    EXPECT_NEAR(instrument.constants.source_distance, condenser, 1e-12);

    physics::f64::SpecimenRecord specimen{};
    const auto exposure = test::exposure_of(instrument.front_vertex_height, 41);
    int arrived = 0, beside_the_stop = 0, beside_the_pupil = 0;
    constexpr std::uint32_t paths = 20000;
    for (std::uint32_t k = 0; k < paths; ++k) {
        const auto emission = physics::f64::emit(instrument.scene(), instrument.constants,
                                                 physics::f64::draw(exposure.seed, exposure.image, {k, 0}, 0u));
        const auto arrival =
            physics::f64::illuminate(instrument.scene(), instrument.constants, specimen, exposure, emission);
        const glm::dvec2 place(emission.ray.position), direction(emission.ray.direction);
        const bool through_the_stop = glm::length(condenser * direction) < 0.6;
        const bool through_the_pupil = glm::length(field_lens / condenser * place) < objective * aperture;
        beside_the_stop += through_the_stop ? 0 : 1;
        beside_the_pupil += through_the_pupil ? 0 : 1;
        ASSERT_EQ(arrival.fate.status == PATH_ALIVE, through_the_stop && through_the_pupil) << k;
        if (arrival.fate.status != PATH_ALIVE) {
            continue;
        }
        ++arrived;
        // The specimen's z points against the light, so one of its axes is turned: lengths alone are compared.
        EXPECT_NEAR(glm::length(glm::dvec2(arrival.position)),
                    objective / field_lens * condenser * glm::length(direction), 1e-9);
        EXPECT_NEAR(glm::length(glm::dvec2(arrival.direction)), field_lens / condenser * glm::length(place) / objective,
                    1e-9);
    }
    EXPECT_GT(arrived, 1000);
    EXPECT_GT(beside_the_pupil, 1000) << "else the pupil was not seen to limit the light";
}

} // namespace
} // namespace vkfv::optics
