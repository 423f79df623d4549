// Kernels in the form for software devices, whose loops ask at their ends too, give the bits of the form for GPUs.
#include "trace/device/device_tracer.hpp"
#include "trace/microscope.hpp"

#include <gtest/gtest.h>

using namespace vkfv;

namespace {

trace::Image expose(const optics::Instrument& instrument, trace::TraceOptions with, bool for_software) {
    with.for_software = for_software;
    return trace::make_device_tracer(instrument, test::steep_specimen(0.65), with)->expose(0.002, 1);
}

// The two forms give the same bits of an image; another seed, the wrong twin, gives others.
void expect_same_bits(const optics::Instrument& instrument, const trace::TraceOptions& with) {
    const auto software = expose(instrument, with, true);
    const auto gpu = expose(instrument, with, false);
    EXPECT_GT(software.detected, 1000U);
    EXPECT_EQ(software.flux.values, gpu.flux.values);
    EXPECT_EQ(software.standard_error.values, gpu.standard_error.values);
    ASSERT_EQ(software.ledger.entries.size(), gpu.ledger.entries.size());
    for (std::size_t k = 0; k < gpu.ledger.entries.size(); ++k) {
        EXPECT_EQ(software.ledger.entries[k].rays, gpu.ledger.entries[k].rays) << gpu.ledger.entries[k].name;
    }
    auto other = with;
    other.seed += 1;
    EXPECT_NE(expose(instrument, other, false).flux.values, software.flux.values);
}

} // namespace

TEST(SoftwareKernels, GiveTheBitsOfThoseForGpus) {
    auto description = test::microscope_description();
    description.detector_pixels = ImageSize::square(32);
    description.turned = true;
    const auto instrument = optics::assemble(description);
    for (const auto estimator : {trace::Estimator::forward, trace::Estimator::backward}) {
        for (const bool in_constants : {false, true}) {
            for (const int bounces : {1, 3}) {
                SCOPED_TRACE(testing::Message()
                             << "backward " << (estimator == trace::Estimator::backward) << ", instrument in constants "
                             << in_constants << ", bounces " << bounces);
                trace::TraceOptions with;
                with.estimator = estimator;
                with.rays = estimator == trace::Estimator::forward ? 600'000 : 1 << 16;
                with.seed = 3;
                with.max_bounces = bounces;
                with.traversal = trace::Traversal::quadtree;
                with.instrument_in_constants = in_constants;
                expect_same_bits(instrument, with);
            }
        }
    }
}
