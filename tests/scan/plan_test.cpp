#include "scan/plan.hpp"

#include "core/messages/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using vkfv::InputError;
using vkfv::scan::ScanPlan;

namespace {

// Micrometres as a user writes them become millimetres by a product that rounds: the counts below are what
// the decimal numbers mean, worked out by hand.
struct Case {
    double start_um, stop_um, step_um;
    std::size_t count;
};

class PlanCounts : public testing::TestWithParam<Case> {};

TEST_P(PlanCounts, AreThoseOfTheDecimalNumbers) {
    const Case& c = GetParam();
    const auto z = ScanPlan{c.start_um * 1e-3, c.stop_um * 1e-3, c.step_um * 1e-3}.positions();
    ASSERT_EQ(z.size(), c.count);
    for (std::size_t i = 0; i < z.size(); ++i) {
        // Product and sum round once each, at most 1e-16 of 1 mm.
        EXPECT_NEAR(z[i], (c.start_um + static_cast<double>(i) * c.step_um) * 1e-3, 1e-15);
    }
}

INSTANTIATE_TEST_SUITE_P(Scan, PlanCounts,
                         testing::Values(Case{0, 0.3, 0.1, 4},                           // 0.3 / 0.1 < 3 in double
                                         Case{-12, 12, 0.8, 31},                         //
                                         Case{-0.3, 0.6, 0.1, 10}, Case{0, 0.7, 0.1, 8}, // 0.7 / 0.1 < 7 in double
                                         Case{-1, 1, 0.7, 3},                            // the stop is not reached
                                         Case{0, 0.2999, 0.1, 3}, // a thousandth of a step short: not reached
                                         Case{5, 5, 0.1, 1},      //
                                         Case{0, 999.9, 0.1, 10000}));

void expect_refused(const ScanPlan& plan, const std::string& key) {
    try {
        plan.positions();
        FAIL() << "accepted " << plan.z_start << " " << plan.z_stop << " " << plan.z_step;
    } catch (const InputError& error) {
        EXPECT_EQ(error.problem().key, key);
        EXPECT_FALSE(error.problem().remedy.empty());
    }
}

TEST(Plan, WhatIsNoScanIsRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    expect_refused({0, 1, 0}, "scan.z_step_um");
    expect_refused({0, 1, -0.1}, "scan.z_step_um");
    expect_refused({0, 1, nan}, "scan.z_step_um");
    expect_refused({0, 1, 1e-4}, "scan.z_step_um"); // 10001 images
    expect_refused({0, 1, 1e-300}, "scan.z_step_um");
    expect_refused({1, 0, 0.1}, "scan.z_stop_um");
    expect_refused({0, infinity, 0.1}, "scan.z_stop_um");
    expect_refused({nan, 1, 0.1}, "scan.z_start_um");
}

} // namespace
