#include "trace/interface/dispatch_pace.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace vkfv::test {
namespace {

constexpr std::uint64_t most = std::uint64_t{1} << 28;
constexpr double longest = 0.2; // s

// The time that a device takes which few paths do not fill.
double seconds_of(std::uint64_t paths, double rate) {
    return std::max(100e-6, static_cast<double>(paths) / rate);
}

TEST(DispatchPace, NoSubmissionIsLongOnAnyDevice) {
    for (const double rate : {1e5, 1e6, 3e7, 1e9, 1e11}) {
        trace::DispatchPace pace(most);
        int waited_for = 0;
        for (int k = 0; k < 50; ++k) {
            const double seconds = seconds_of(pace.paths(), rate);
            ASSERT_LE(seconds, longest) << rate;
            waited_for += pace.settled() ? 0 : 1;
            pace.took(pace.paths(), seconds);
        }
        EXPECT_TRUE(pace.settled());
        EXPECT_LE(waited_for, 6) << rate;
        // No submission is so short that it keeps the device waiting.
        EXPECT_TRUE(pace.paths() == most || seconds_of(pace.paths(), rate) > 0.05) << rate;
    }
}

TEST(DispatchPace, FollowsADeviceThatOthersUseToo) {
    trace::DispatchPace pace(most);
    for (const double rate : {1e8, 1e7, 1e9}) {
        for (int k = 0; k < 10; ++k) {
            pace.took(pace.paths(), seconds_of(pace.paths(), rate));
        }
        const double seconds = seconds_of(pace.paths(), rate);
        EXPECT_TRUE(0.05 < seconds && seconds < longest) << rate << ": " << seconds;
    }
}

TEST(DispatchPace, TheRestOfAnExposureTellsNoRate) {
    trace::DispatchPace pace(most);
    for (int k = 0; k < 10; ++k) {
        pace.took(pace.paths(), seconds_of(pace.paths(), 1e8));
    }
    const auto before = pace.paths();
    pace.took(10, 100e-6);
    EXPECT_EQ(pace.paths(), before);
    // A rest that takes long does tell the rate.
    pace.took(10, 1);
    EXPECT_LT(pace.paths(), before);
}

TEST(DispatchPace, NeverExceedsWhatMemoryHolds) {
    trace::DispatchPace pace(1000);
    for (int k = 0; k < 10; ++k) {
        EXPECT_LE(pace.paths(), 1000u);
        pace.took(pace.paths(), 1e-6);
    }
    EXPECT_EQ(trace::DispatchPace(0).paths(), 1u);
}

} // namespace
} // namespace vkfv::test
