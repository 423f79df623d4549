// The image of a specimen that the stage holds beside its place moves, whoever traces it.
#include "trace/device/device_tracer.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/microscope.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace vkfv {
namespace {

constexpr int side = 16;
constexpr int columns = 3, rows = -2; // how far it moves, pixels

// The sum of squares over variance, a pixel, of one image against another moved by so many pixels; 1 where they agree.
double difference(const trace::Image& first, const trace::Image& second, int right, int up) {
    double squares = 0, variance = 0;
    for (int row = 3; row < side - 3; ++row) {
        for (int column = 4; column < side - 4; ++column) {
            squares += std::pow(first.flux(column, row) - second.flux(column + right, row + up), 2);
            variance += std::pow(first.standard_error(column, row), 2) +
                        std::pow(second.standard_error(column + right, row + up), 2);
        }
    }
    return squares / variance;
}

} // namespace

TEST(Displacement, MovesTheImage) {
    auto description = test::microscope_description();
    description.field_stop_radius = 0.25;
    description.detector_width = side * 0.02;
    description.detector_pixels = ImageSize::square(side);
    description.turned = true;
    const auto instrument = optics::assemble(description);
    const double pitch = instrument.first_order.pixel_pitch;
    // The specimen's grating lights the pixels unlike each other.
    auto specimen = test::rough_specimen();
    specimen.reflectance = specimen::make_reflectance_map(
        {.kind = specimen::Reflectance::Kind::grating, .angle = 0.6, .period = 0.013}, {-0.15, -0.15, 0.15, 0.15}, {});
    const trace::FocalPosition beside(0.002, glm::dvec2(columns * pitch, rows * pitch));
    for (const auto& [estimator, traversal] : {std::pair{trace::Estimator::forward, trace::Traversal::quadtree},
                                               {trace::Estimator::backward, trace::Traversal::bvh}}) {
        trace::TraceOptions options;
        options.estimator = estimator;
        options.rays = estimator == trace::Estimator::forward ? 3'000'000 : side * side * 256;
        options.max_bounces = 2;
        options.traversal = traversal;
        const auto tracer = trace::make_device_tracer(instrument, specimen, options);
        const auto there = tracer->expose(0.002, 1);
        const auto moved = tracer->expose(beside, 2);
        EXPECT_NEAR(difference(there, moved, columns, rows), 1, 0.6) << static_cast<int>(estimator);
        EXPECT_GT(difference(there, moved, 0, 0), 3) << static_cast<int>(estimator); // wrong twin
    }
    trace::TraceOptions options;
    options.rays = 200'000;
    options.max_bounces = 2;
    const auto on_host = trace::make_host_tracer(instrument, specimen, options)->expose(beside, 2);
    const auto on_device = trace::make_device_tracer(instrument, specimen, options)->expose(beside, 2);
    int apart = 0;
    for (std::size_t pixel = 0; pixel < on_host.flux.values.size(); ++pixel) {
        apart += on_host.flux.values[pixel] == on_device.flux.values[pixel] ? 0 : 1;
    }
    EXPECT_LT(apart, 20); // rays within rounding of an edge
}

} // namespace vkfv
