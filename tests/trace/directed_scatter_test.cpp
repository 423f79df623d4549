// Directed scatter has the image and the ledger of the analog form, with less noise.
#include "trace/device/device_tracer.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/microscope.hpp"

#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace vkfv;
using namespace vkfv::physics::f64;

namespace {

trace::TraceOptions options(bool directed, int max_bounces = 2) {
    trace::TraceOptions result;
    result.rays = 100000;
    result.seed = 3;
    result.max_bounces = max_bounces;
    result.traversal = trace::Traversal::quadtree;
    result.directed_scatter = directed;
    return result;
}

// The detector has few pixels, so that each has hundreds of detections and its mean is normally distributed.
optics::Instrument coarse_microscope() {
    auto description = test::microscope_description();
    description.detector_pixels = ImageSize::square(8);
    return optics::assemble(description);
}

specimen::Specimen mixed_specimen() {
    auto result = test::rough_specimen(0, 0.008, 0.01);
    result.material.lobes = {{"mirror", 0.2, {}}, {"henyey-greenstein", 0.5, {0.8}}, {"lambertian", 0.2, {}}};
    return result;
}

// A specimen whose first lobe absorbs a third of its light.
specimen::Specimen lossy_specimen() {
    auto result = test::rough_specimen(0, 0.008, 0.01);
    result.material.lobes = {{"ggx", 0.8, {0.6}}, {"mirror", 0.1, {}}};
    return result;
}

trace::Image expose(const optics::Instrument& instrument, const specimen::Specimen& specimen,
                    const trace::TraceOptions& with) {
    return trace::make_device_tracer(instrument, specimen, with)->expose(0.001, 2);
}

double same_expectation_p(const trace::Image& a, const trace::Image& b) {
    double chi_square = 0, degrees = 0;
    for (std::size_t k = 0; k < a.flux.values.size(); ++k) {
        const double variance = std::pow(a.standard_error.values[k], 2) + std::pow(b.standard_error.values[k], 2);
        if (variance > 0) {
            chi_square += std::pow(a.flux.values[k] - b.flux.values[k], 2) / variance;
            degrees += 1;
        }
    }
    return test::chi_square_tail(chi_square, degrees);
}

double variance(const trace::Image& image) {
    double sum = 0;
    for (const double error : image.standard_error.values) {
        sum += error * error;
    }
    return sum;
}

double power(const trace::Image& image, const std::string& name) {
    const auto found = std::ranges::find(image.ledger.entries, name, &trace::Ledger::Entry::name);
    return found != image.ledger.entries.end() ? found->power : NAN;
}

} // namespace

// A plane scatters by Lambert's law under the middle of the gate, which is a circle of the slope r there: the share r^2
// / (1 + r^2) of its light passes. Both samples together have that mean; either with the weight 1 has another.
TEST(DirectedScatter, BothSamplesTogetherHaveTheMeanOfTheLightInTheGate) {
    const auto instrument = test::microscope().constants;
    const Lobe lambertian{SCATTER_LAMBERTIAN, 1, 0, 0, 0, 0, {}};
    const real3 down(std::sin(0.3), 0, -std::cos(0.3)), up(0, 0, 1);
    const Incidence incidence = make_incidence(down, up);
    const GateDisc disc = gate_disc(instrument, 0.01, real3(0.0));
    ASSERT_GT(disc.radius, 0.2);
    const double share = disc.radius * disc.radius / (1 + disc.radius * disc.radius);
    constexpr std::uint32_t draws = 400000;
    double sum = 0, squares = 0, own_alone = 0, aimed_alone = 0;
    for (std::uint32_t k = 0; k < draws; ++k) {
        const Draws u = draw(9, 1, uvec2(k, 0), 0);
        const ScatterTry own = lambertian_try(incidence, u.u0, u.u1, 0.5);
        const double own_ratio = density_ratio(lambertian, incidence, disc, own.direction);
        const double own_weight =
            passes_gate(instrument, 0.01, real3(0.0), own.direction) ? own_ratio / (1 + own_ratio) : 0;
        const double aimed_ratio = density_ratio(lambertian, incidence, disc, direction_in_disc(disc, u.u2, u.u3));
        const double weight = own_weight + aimed_ratio / (1 + aimed_ratio);
        sum += weight;
        squares += weight * weight;
        own_alone += own_weight > 0 ? 1 + aimed_ratio / (1 + aimed_ratio) : aimed_ratio / (1 + aimed_ratio);
        aimed_alone += own_weight + aimed_ratio;
    }
    const double mean = sum / draws;
    const double error = std::sqrt((squares / draws - mean * mean) / draws);
    EXPECT_LT(std::abs(mean - share) / error, 4.0);              // 6e-5
    EXPECT_GT(std::abs(own_alone / draws - share) / error, 4.0); // wrong twins
    EXPECT_GT(std::abs(aimed_alone / draws - share) / error, 4.0);
}

TEST(DirectedScatter, TheAimIsTheGate) {
    const auto instrument = test::microscope().constants;
    int inside = 0, outside = 0;
    constexpr int points = 2000;
    for (std::uint32_t k = 0; k < points; ++k) {
        const Draws u = draw(10, 1, uvec2(k, 0), 0);
        const real3 position(u.u0 - 0.5, u.u1 - 0.5, -0.2 * u.u2);
        GateDisc disc = gate_disc(instrument, 0.05, position);
        inside += passes_gate(instrument, 0.05, position, direction_in_disc(disc, 0.999999, u.u3)) ? 1 : 0;
        disc.radius *= 1.000002;
        outside += passes_gate(instrument, 0.05, position, direction_in_disc(disc, 0.999999, u.u3)) ? 0 : 1;
    }
    EXPECT_EQ(inside, points);
    EXPECT_EQ(outside, points);
}

// Chi-square per pixel and a z-test of the sum are eighteen tests that err together once in 1e4. The wrong twin lacks
// two fifths of the light.
TEST(DirectedScatter, TheExpectedImageIsTheAnalogOne) {
    const auto instrument = coarse_microscope();
    const double level = test::sidak(1e-4, 18);
    const double z_limit = 4.5; // two-sided, 7e-6
    for (const int bounces : {1, 4}) {
        for (const auto& specimen : {test::rough_specimen(0.3), mixed_specimen(), lossy_specimen()}) {
            auto analog = options(false, bounces);
            analog.rays = 600000;
            analog.seed = 77;
            const auto expected = expose(instrument, specimen, analog);
            ASSERT_GT(expected.detected, 64u * 30);
            auto with = options(true, bounces);
            with.rays = 200000;
            const auto directed = expose(instrument, specimen, with);
            const auto z = [&](const trace::Image& image) {
                return std::abs(power(image, "detected") - power(expected, "detected")) /
                       std::sqrt(variance(image) + variance(expected));
            };
            EXPECT_GT(same_expectation_p(directed, expected), level) << bounces;
            EXPECT_LT(z(directed), z_limit) << bounces;
            auto twin = specimen;
            for (auto& lobe : twin.material.lobes) {
                lobe.weight *= 0.6;
            }
            const auto otherwise = expose(instrument, twin, with);
            EXPECT_LT(same_expectation_p(otherwise, expected), level) << bounces;
            EXPECT_GT(z(otherwise), z_limit) << bounces;
        }
    }
}

// At g = 0.3 a tenth of the light in the lobe enters the pupil.
TEST(DirectedScatter, TheImageHasLessNoise) {
    const auto instrument = coarse_microscope();
    const auto specimen = test::rough_specimen(0.3);
    const auto analog = expose(instrument, specimen, options(false));
    const auto directed = expose(instrument, specimen, options(true));
    EXPECT_LT(variance(directed), 0.2 * variance(analog)); // 0.10 seen
}

// Over images of other random numbers the residual varies as its stated error says: chi-square of 16 images, 1e-4 each.
TEST(DirectedScatter, TheLedgerClosesInExpectation) {
    const auto instrument = coarse_microscope();
    for (const auto& [specimen, bounces] :
         {std::pair{mixed_specimen(), 1}, {mixed_specimen(), 4}, {lossy_specimen(), 1}, {lossy_specimen(), 4}}) {
        auto with = options(true, bounces);
        with.rays = 40000;
        const auto tracer = trace::make_device_tracer(instrument, specimen, with);
        constexpr int images = 16;
        double chi_square = 0, sum = 0, without_image = 0;
        for (std::uint32_t image = 0; image < images; ++image) {
            const auto exposed = tracer->expose(0.001, image);
            const double error = exposed.ledger.residual_error;
            ASSERT_GT(error, 0);
            ASSERT_LT(error, 1e-5 * exposed.ledger.emitted);
            sum += exposed.ledger.residual() / error;
            chi_square += std::pow(exposed.ledger.residual() / error, 2);
            without_image += (exposed.ledger.residual() + power(exposed, "detected")) / error;
        }
        EXPECT_LT(std::abs(sum) / std::sqrt(images), 4.0) << bounces; // 6e-5
        EXPECT_GT(test::chi_square_tail(chi_square, images), 5e-5) << bounces;
        EXPECT_LT(test::chi_square_tail(chi_square, images), 1 - 5e-5) << bounces;
        EXPECT_GT(without_image / std::sqrt(images), 4.0) << bounces; // wrong twin
    }
}

// A mirror cannot be aimed: every ray keeps its way and its weight 1.
TEST(DirectedScatter, AMirrorStaysAsItWas) {
    const auto instrument = coarse_microscope();
    auto specimen = test::rough_specimen(0);
    for (const specimen::Lobe& lobe : {specimen::Lobe{"mirror", 1, {}}, specimen::Lobe{"henyey-greenstein", 1, {1}}}) {
        specimen.material.lobes = {lobe};
        const auto analog = expose(instrument, specimen, options(false));
        const auto directed = expose(instrument, specimen, options(true));
        ASSERT_GT(analog.detected, 200u);
        EXPECT_EQ(directed.flux.values, analog.flux.values) << lobe.model;
        EXPECT_EQ(directed.standard_error.values, analog.standard_error.values) << lobe.model;
        EXPECT_LT(std::abs(directed.ledger.residual()), 1e-9 * directed.ledger.emitted);
        EXPECT_EQ(directed.ledger.residual_error, 0);
    }
}

TEST(DirectedScatter, BitsDoNotDependOnTheBatch) {
    const auto instrument = coarse_microscope();
    const auto specimen = mixed_specimen();
    const auto reference = expose(instrument, specimen, options(true, 4));
    auto with = options(true, 4);
    with.batch = 65536;
    const auto image = expose(instrument, specimen, with);
    EXPECT_EQ(image.flux.values, reference.flux.values);
    EXPECT_EQ(image.standard_error.values, reference.standard_error.values);
    EXPECT_EQ(image.ledger.residual(), reference.ledger.residual());
    EXPECT_EQ(image.ledger.residual_error, reference.ledger.residual_error);
    with.seed = 4;
    EXPECT_NE(expose(instrument, specimen, with).flux.values, reference.flux.values); // wrong twin
}

// Every traversal, and the host in double, trace the same paths: images differ by ties within rounding alone, as in the
// analog form.
TEST(DirectedScatter, TraversalsAndHostGiveTheSameImage) {
    const auto instrument = coarse_microscope();
    const auto specimen = test::steep_specimen(0.65);
    const auto quadtree = expose(instrument, specimen, options(true, 3));
    const auto differing = [&](const trace::Image& other) {
        double sum = 0;
        for (std::size_t k = 0; k < other.flux.values.size(); ++k) {
            sum += std::abs(quadtree.flux.values[k] - other.flux.values[k]);
        }
        return sum / quadtree.ledger.entries[0].power;
    };
    for (const auto traversal : {trace::Traversal::ray_query, trace::Traversal::bvh}) {
        auto with = options(true, 3);
        with.traversal = traversal;
        EXPECT_LT(differing(expose(instrument, specimen, with)), 1e-3);
    }
    const auto host = trace::make_host_tracer(instrument, specimen, options(true, 3))->expose(0.001, 2);
    EXPECT_LT(differing(host), 5e-3);
    EXPECT_NEAR(host.ledger.residual_error, quadtree.ledger.residual_error, 1e-2 * quadtree.ledger.residual_error);
    EXPECT_GT(differing(expose(instrument, test::steep_specimen(0.6), options(true, 3))), 5e-3); // wrong twin
}

// Path by path the fate, place and weight are the same but for ties within rounding, which mirrors on facets enlarge:
// 76 of 16146 that arrived when this was written, and 8 of 770 in the analog form.
TEST(DirectedScatter, HostAndDeviceTraceTheSamePaths) {
    const auto instrument = test::microscope();
    const auto specimen = mixed_specimen();
    constexpr std::uint32_t paths = 30000;
    const auto host = trace::host_paths(instrument, specimen, options(true, 3), 0.001, 7, 0, paths);
    const auto compare = [&](std::uint32_t image) {
        const auto device = trace::device_paths(instrument, specimen, options(true, 3), 0.001, image, 0, paths);
        std::uint32_t differing = 0, detected = 0;
        for (std::uint32_t k = 0; k < paths; ++k) {
            const bool arrived = host[k].status == PATH_DETECTED;
            const bool same = host[k].status == device[k].status && host[k].surface == device[k].surface &&
                              (!arrived || (std::hypot(host[k].x - device[k].x, host[k].y - device[k].y) < 0.5e-3 &&
                                            std::abs(host[k].weight - device[k].weight) < 1e-4));
            differing += same ? 0 : 1;
            detected += arrived && host[k].weight != 1 ? 1 : 0;
        }
        EXPECT_GT(detected, 1000u);
        return differing;
    };
    EXPECT_LT(compare(7), paths / 250);
    EXPECT_GT(compare(8), paths / 100); // wrong twin: other paths
}
