// Light that meets the specimen once, from a source that is aimed at the detector, makes the image of all light that
// passes the illumination.
#include "trace/agreement.hpp"
#include "trace/device/device_tracer.hpp"
#include "trace/host/host_tracer.hpp"
#include "trace/interface/light_sources.hpp"
#include "trace/interface/traced_instrument.hpp"
#include "trace/microscope.hpp"

#include "support/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace vkfv;
using namespace vkfv::physics::f64;

namespace {

trace::TraceOptions once() {
    trace::TraceOptions result;
    result.rays = 2'000'000;
    result.seed = 3;
    result.max_bounces = 1;
    return result;
}

// A specimen with points up to 0.03 mm from the focal planes of these tests, where their light spreads.
specimen::Specimen high_specimen() {
    return test::rough_specimen(0.65, 0.004, 0.03);
}

// The microscope with its aim at the detector, which is wide, as cameras are.
optics::Instrument aimed_microscope(double greatest_defocus = 0.03) {
    auto description = test::microscope_description();
    description.detector_pixels = {.columns = 64, .rows = 48};
    description.greatest_defocus = greatest_defocus;
    description.single_scatter = true;
    return optics::assemble(description);
}

double power_of(const trace::Ledger& ledger, const std::string& name) {
    double power = 0;
    for (const auto& entry : ledger.entries) {
        power += entry.name == name ? entry.power : 0;
    }
    return power;
}

} // namespace

TEST(DetectorAim, MakesTheImageOfAllLightWithFewerRays) {
    const auto aimed = aimed_microscope();
    auto whole = aimed;
    whole.single_scatter_aim.reset();
    const auto specimen = high_specimen();
    constexpr double out_of_focus = 0.01;
    auto with = once();
    const auto image = trace::make_device_tracer(aimed, specimen, with)->expose(out_of_focus, 2);
    with.seed = 4;
    const auto of_all = trace::make_device_tracer(whole, specimen, with)->expose(out_of_focus, 2);
    EXPECT_GT(test::agreement(image, of_all), 1e-4);
    const double sum = test::total(image.flux), sum_of_all = test::total(of_all.flux);
    const double spread = sum * std::sqrt(1.0 / double(image.detected) + 1.0 / double(of_all.detected));
    EXPECT_LT(std::abs(sum - sum_of_all), 4 * spread);
    EXPECT_GT(double(image.detected), 1.2 * double(of_all.detected));
    EXPECT_LT(std::abs(image.ledger.residual()), 1e-6 * image.ledger.emitted);
    EXPECT_LT(power_of(image.ledger, "beside the detector"), 0.7 * power_of(of_all.ledger, "beside the detector"));
    EXPECT_GT(power_of(image.ledger, "not aimed at"), power_of(of_all.ledger, "not aimed at"));
    // The wrong twin has shorter sides: its image lacks light at the edges and has all of it elsewhere.
    auto narrow = aimed;
    *narrow.single_scatter_aim *= 0.65;
    EXPECT_LT(test::total(trace::make_device_tracer(narrow, specimen, with)->expose(out_of_focus, 2).flux),
              sum_of_all - 8 * spread);
}

// The aim is taken only for paths that cannot come back from beside the field.
TEST(DetectorAim, IsTakenForSingleScatterAlone) {
    const auto instrument = aimed_microscope();
    const auto is_taken = [&](const trace::TraceOptions& options) {
        return (trace::as_traced(instrument, options).features & FEATURE_AIMED_RECTANGLE) != 0;
    };
    auto with = once();
    EXPECT_TRUE(is_taken(with));
    with.max_bounces = 2;
    EXPECT_FALSE(is_taken(with));
    with = once();
    with.nonsequential = true;
    EXPECT_FALSE(is_taken(with));
    with = once();
    with.estimator = trace::Estimator::backward;
    EXPECT_FALSE(is_taken(with));
    const auto digest = trace::traced_digest(instrument, once());
    auto whole = instrument;
    whole.single_scatter_aim.reset();
    EXPECT_NE(digest, trace::traced_digest(whole, once())); // images of another aim are other images
}

// Fates are those of the host in double; paths within float rounding of an edge may differ (Paths.*).
TEST(DetectorAim, HostAndDeviceTraceTheSamePaths) {
    const auto instrument = optics::aimed_for_single_scatter(aimed_microscope());
    ASSERT_NE(instrument.features & FEATURE_AIMED_RECTANGLE, 0u);
    const auto specimen = high_specimen();
    constexpr std::uint32_t paths = 1'000'000;
    auto with = once();
    with.rays = paths; // paths of the whole image
    const auto host = trace::host_paths(instrument, specimen, with, 0.002, 7, 0, paths);
    const auto device = trace::device_paths(instrument, specimen, with, 0.002, 7, 0, paths);
    std::uint32_t differing = 0, detected = 0;
    for (std::uint32_t k = 0; k < paths; ++k) {
        const bool same = host[k].status == device[k].status && host[k].surface == device[k].surface;
        differing += same ? 0 : 1;
        detected += same && host[k].status == PATH_DETECTED ? 1 : 0;
        if (same && host[k].status == PATH_DETECTED) {
            EXPECT_LT(std::hypot(host[k].x - device[k].x, host[k].y - device[k].y), 1e-3) << k;
        }
    }
    EXPECT_GT(detected, 10000u);
    EXPECT_LE(differing, paths / 2000);
}
