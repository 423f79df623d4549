// Patterns and uneven light in the plane of the field stop look on the specimen as closed forms say, in all ways of
// tracing.
#include "trace/agreement.hpp"
#include "trace/device/device_tracer.hpp"
#include "trace/elements.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/microscope.hpp"

#include "core/mathematics/units.hpp"
#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <complex>
#include <numeric>

using namespace vkfv;
using namespace vkfv::physics::f64;
using test::agreement;
using test::total;
using trace::Estimator;
using trace::Traversal;

namespace {

constexpr double level = 1e-3;  // false-positive rate of each chi-square test here
constexpr double field = 0.032; // mm, of 16 pixels of 2 um

optics::InstrumentDescription small_description() {
    auto description = test::ideal_microscope_description();
    description.source.radius = 1.1; // more than fills the pupil
    description.field_stop_radius = 0.3;
    description.detector_width = 0.32;
    description.detector_pixels = ImageSize::square(16);
    description.turned = true;
    return description;
}

optics::Instrument with(const std::optional<optics::LightField>& light) {
    auto description = small_description();
    description.light_field = light;
    return optics::assemble(description);
}

// The instrument with an illuminator of real lenses in place of the ideal one.
optics::Instrument by_real_lenses(const std::optional<optics::LightField>& light) {
    auto description = small_description();
    const auto real = test::microscope_description();
    description.illumination = real.illumination;
    description.source.radius = real.source.radius;
    description.light_field = light;
    return optics::assemble(description);
}

// Light with nothing but a falloff, until a pattern is given.
optics::LightField even() {
    optics::LightField light;
    light.record.pattern.lowest = light.record.pattern.highest = 1;
    light.record.pattern.of_light = 1;
    return light;
}

// A pattern of squares of chance, of another number along y and with no symmetry; and the light falls off from beside
// the axis.
optics::LightField uneven(bool upside_down = false) {
    optics::LightField light = even();
    Pattern& pattern = light.record.pattern;
    pattern = {.lowest = 0.15,
               .highest = 1,
               .centre_x = 0.01,
               .centre_y = -0.02,
               .axis_x = 0.8,
               .axis_y = 0.6,
               .per_mm = 1 / 0.045,
               .cycles = 0,
               .columns = 9,
               .rows = 8,
               .square = 0,
               .of_light = 1,
               .kind = PATTERN_GRID};
    light.points = Grid<float>(9, 8);
    std::uint32_t bits = 1;
    for (float& value : light.points.values) {
        bits = bits * 1664525u + 1013904223u;
        value = static_cast<float>(bits >> 24) / 255.0F;
    }
    if (upside_down) {
        std::ranges::reverse(light.points.values);
    }
    light.record.falloff = 6;
    light.record.brightest_x = 0.1;
    light.record.brightest_y = 0.05;
    return light;
}

trace::TraceOptions options(Estimator estimator, std::uint64_t rays, int max_bounces = 1) {
    trace::TraceOptions result;
    result.estimator = estimator;
    result.rays = rays;
    result.seed = 3;
    result.max_bounces = max_bounces;
    return result;
}

trace::Image expose(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                    const trace::TraceOptions& by, bool on_host = false, double focal_height = 0) {
    const auto tracer = on_host ? trace::make_host_tracer(instrument, specimen, by)
                                : trace::make_device_tracer(instrument, specimen, by);
    return tracer->expose(focal_height, 1);
}

specimen::Specimen flat(const std::string& scatter) {
    specimen::Analytic plane;
    plane.x_min = plane.y_min = -0.05;
    plane.x_max = plane.y_max = 0.05;
    return {plane, specimen::Material{{{scatter, 1, {}}}}};
}

// The Fourier coefficient of so many periods in the field, of the image over that without a pattern.
std::complex<double> coefficient(const trace::Image& image, const trace::Image& bare, int along_x, int along_y) {
    const int pixels = image.flux.columns;
    std::complex<double> sum = 0;
    for (int row = 0; row < pixels; ++row) {
        for (int column = 0; column < pixels; ++column) {
            const double turns =
                (along_x * (column + 0.5 - 0.5 * pixels) + along_y * (row + 0.5 - 0.5 * pixels)) / pixels;
            sum += image.flux(column, row) / bare.flux(column, row) * std::polar(1.0, -2 * pi * turns);
        }
    }
    return sum / static_cast<double>(pixels * pixels);
}

constexpr int periods_x = 3, periods_y = 4; // in the field

optics::LightField grating(double magnification) {
    optics::LightField light = even();
    Pattern& pattern = light.record.pattern;
    pattern.lowest = 0;
    pattern.kind = PATTERN_GRATING;
    pattern.axis_x = 0.6;
    pattern.axis_y = 0.8;
    pattern.per_mm = std::hypot(periods_x, periods_y) / field * std::abs(magnification);
    return light;
}

} // namespace

// The light's frame is the specimen's turned half a turn about x, and the stop's image upside down.
TEST(LightField, FallsOffFromItsBrightestPlace) {
    optics::LightField light = even();
    light.record.falloff = 10;
    light.record.brightest_x = 0.06;
    light.record.brightest_y = 0.03;
    const auto instrument = with(light);
    const double m = instrument.first_order.field_stop_magnification;
    EXPECT_NEAR(m, -20.0 / 150, 1e-9);
    const auto white = flat("lambertian");
    const auto by = options(Estimator::backward, 1 << 18);
    for (const bool on_host : {false, true}) {
        const auto bare = expose(with(std::nullopt), white, by, on_host);
        const auto image = expose(instrument, white, by, on_host);
        double worst = 0, worst_twin = 0;
        for (int row = 0; row < 16; ++row) {
            for (int column = 0; column < 16; ++column) {
                const double x = (column + 0.5) * field / 16 - field / 2, y = (row + 0.5) * field / 16 - field / 2;
                const auto share = [&](double u, double v) {
                    return 1 - 10 * (std::pow(u - 0.06, 2) + std::pow(v - 0.03, 2));
                };
                const double seen = image.flux(column, row) / bare.flux(column, row);
                worst = std::max(worst, std::abs(seen - share(x / m, -y / m)));
                worst_twin = std::max(worst_twin, std::abs(seen - share(x / m, y / m)));
            }
        }
        EXPECT_LT(worst, 0.01); // noise at these rays leaves 0.004 at the worst of 256 pixels
        EXPECT_GT(worst_twin, 0.05);
    }
}

// A mirror shows the stop's plane: in focus a grating has the pixels' contrast alone. If it is out of focus by h, its
// light comes from within 2 h tan(theta), uniform over the aperture's direction cosines.
TEST(LightField, AMirrorShowsAGratingAndLosesItOutOfFocus) {
    const auto bare_instrument = with(std::nullopt);
    const auto instrument = with(grating(bare_instrument.first_order.field_stop_magnification));
    const auto mirror = flat("mirror");
    const auto by = options(Estimator::backward, 1 << 14);
    const auto sinc = [](double periods) { return std::sin(pi * periods / 16) / (pi * periods / 16); };
    const double period = field / std::hypot(periods_x, periods_y);
    const auto blurred = [&](double height) {
        double sum = 0;
        constexpr int parts = 400;
        for (int k = 0; k < parts; ++k) {
            const double sine = 0.28 * std::sqrt((k + 0.5) / parts);
            const double shift = 2 * height * sine / std::sqrt(1 - sine * sine);
            sum += std::cyl_bessel_j(0, 2 * pi * std::abs(shift) / period) / parts;
        }
        return sum;
    };
    for (const double height : {0.0, 0.003}) {
        SCOPED_TRACE(height);
        const auto image = expose(instrument, mirror, by, false, height);
        const auto bare = expose(bare_instrument, mirror, by, false, height);
        EXPECT_NEAR(coefficient(image, bare, 0, 0).real(), 0.5, 0.01);
        const double expected = 0.25 * sinc(periods_x) * sinc(periods_y) * blurred(height);
        EXPECT_LT(std::abs(coefficient(image, bare, periods_x, -periods_y) - expected), 0.012);
        EXPECT_LT(std::abs(coefficient(image, bare, periods_x, periods_y)), 0.012); // the twin that is not turned
    }
    EXPECT_LT(blurred(0.003), 0.75);
}

// Forward from the source, backward from the pixels, and by light that finds its own way the expectation is one.
TEST(LightField, AllWaysOfTracingHaveOneExpectation) {
    const auto instrument = with(uneven());
    const auto specimen = test::smooth_specimen();
    const auto backward = options(Estimator::backward, 1 << 18, 2);
    const auto expected = expose(instrument, specimen, backward);
    auto own_way = options(Estimator::forward, 500'000, 2);
    own_way.nonsequential = true;
    own_way.traversal = Traversal::bvh;
    const auto forward = expose(instrument, specimen, options(Estimator::forward, 250'000, 2));
    const auto nonsequential = expose(instrument, specimen, own_way);
    ASSERT_GT(forward.detected, 8000u);
    ASSERT_GT(nonsequential.detected, 4000u);
    EXPECT_GT(agreement(forward, expected), level);
    EXPECT_GT(agreement(nonsequential, expected), level);
    EXPECT_GT(agreement(expose(instrument, specimen, options(Estimator::forward, 60'000, 2), true), expected), level);
    // The wrong twins are the pattern upside down, and light that is brightest on the axis.
    auto centred = uneven();
    centred.record.brightest_x = centred.record.brightest_y = 0;
    for (const auto& twin : {uneven(true), centred}) {
        EXPECT_LT(agreement(forward, expose(with(twin), specimen, backward)), level);
    }
}

// In a reticle the pattern is on the first face of a plate of glass.
TEST(LightField, IsMetOnGlassByAllWaysOfTracing) {
    auto description = small_description();
    auto& surfaces = description.illumination.surfaces;
    const auto front = std::ranges::find(surfaces, optics::SurfaceRole::field_stop, &optics::PrescribedSurface::role);
    ASSERT_NE(front, surfaces.end());
    optics::PrescribedSurface back;
    back.medium_after = front->medium_after;
    back.thickness = front->thickness - 2;
    ASSERT_GT(back.thickness, 0);
    front->medium_after = optics::Medium::constant("glass", 1.5, "test");
    front->thickness = 2;
    surfaces.insert(front + 1, back);
    const auto lit_by = [&](const std::optional<optics::LightField>& light) {
        description.light_field = light;
        return optics::assemble(description);
    };
    const auto specimen = test::smooth_specimen();
    auto own_way = options(Estimator::forward, 500'000, 2);
    own_way.nonsequential = true;
    own_way.traversal = Traversal::bvh;
    const auto nonsequential = expose(lit_by(uneven()), specimen, own_way);
    ASSERT_GT(nonsequential.detected, 4000u);
    const auto backward = options(Estimator::backward, 1 << 18, 2);
    EXPECT_GT(agreement(nonsequential, expose(lit_by(uneven()), specimen, backward)), level);
    EXPECT_LT(agreement(nonsequential, expose(lit_by(uneven(true)), specimen, backward)), level);
    EXPECT_LT(agreement(nonsequential, expose(lit_by(even()), specimen, backward)), level);
}

// The light that the pattern takes is an entry of the ledger at the stop: half of what comes through the hole around
// it.
TEST(LightField, TheLedgerCountsWhatThePatternTakes) {
    optics::LightField light = even();
    light.record.pattern.lowest = 0.2;
    light.record.pattern.highest = 0.8;
    light.record.pattern.kind = PATTERN_CHECKERBOARD;
    light.record.pattern.axis_x = 1;
    light.record.pattern.per_mm = 1 / 0.02;
    using Status = trace::Ledger::Status;
    const auto image = expose(by_real_lenses(light), flat("lambertian"), options(Estimator::forward, 400'000));
    EXPECT_LT(std::abs(image.ledger.residual()), 1e-6 * image.ledger.emitted);
    double taken = 0, before = 0, all = 0;
    int stop = -1;
    for (const auto& entry : image.ledger.entries) {
        if (entry.status == Status::lost_in_reflection && entry.rays > 0) {
            EXPECT_NE(entry.name.find("field stop"), std::string::npos) << entry.name;
            taken = static_cast<double>(entry.rays);
            stop = entry.surface;
        }
    }
    for (const auto& entry : image.ledger.entries) {
        const bool on_the_way = entry.train == trace::Train::illumination && entry.surface <= stop;
        const auto rays = static_cast<double>(entry.rays);
        before += on_the_way && entry.status == Status::vignetted ? rays : 0;
        all += rays;
    }
    ASSERT_GT(taken, 2000);
    const double arrived = static_cast<double>(image.rays) - before;
    EXPECT_NEAR(taken / arrived, 0.5, 4 * std::sqrt(0.25 / arrived) + 0.002);
    EXPECT_GE(all, static_cast<double>(image.rays));
}
