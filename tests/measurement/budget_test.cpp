// Uncertainties combine as the guides' own examples do, and inputs deviate as their distributions say.
#include "measurement/budget/combined_uncertainty.hpp"
#include "measurement/budget/input_draws.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace vkfv::measurement {
namespace {

using Distribution = UncertainInput::Distribution;

UncertainInput input(Distribution distribution, double uncertainty, double degrees = 1e9) {
    return {.key = "stage.scale_error",
            .distribution = distribution,
            .uncertainty = uncertainty,
            .degrees_of_freedom = degrees};
}

// Results of a model for so many trials.
template <class Model>
TrialStatistics of_trials(const Uncertainty& uncertainty, int trials, const Model& model) {
    const InputDraws draws(uncertainty, 7);
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(trials));
    for (int k = 0; k < trials; ++k) {
        values.push_back(model(draws.deviations(static_cast<std::uint32_t>(k))));
    }
    return statistics_of(std::move(values));
}

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

// JCGM 101, 9.2.3: four even distributions of standard deviation 1 have the sum's interval 2 x 3.88 wide, where the
// Gaussian one is 2 x 3.92.
TEST(Budget, TrialsMakeTheIntervalOfASumOfEvenDistributions) {
    const Uncertainty four{.inputs = std::vector(4, input(Distribution::rectangular, 1))};
    const auto trials = of_trials(four, 200000, sum);
    EXPECT_NEAR(trials.standard_deviation, 2, 0.01);
    EXPECT_NEAR(trials.mean, 0, 0.02);
    EXPECT_NEAR(trials.high, 3.88, 0.03);
    EXPECT_NEAR(trials.low, -3.88, 0.03);
    const std::vector<Contribution> parts(4, {.value = 1, .degrees_of_freedom = 1e9});
    EXPECT_NEAR(combined(parts).expanded_uncertainty(), 3.92, 0.005);
}

// JCGM 101, 9.2.4: three of standard deviation 1 and one of 10 have the interval 2 x 17.0 wide, where the Gaussian one
// is 2 x 19.9.
TEST(Budget, TrialsMakeTheIntervalOfOneLargeEvenDistribution) {
    Uncertainty four{.inputs = std::vector(4, input(Distribution::rectangular, 1))};
    four.inputs.back().uncertainty = 10;
    const auto trials = of_trials(four, 200000, sum);
    EXPECT_NEAR(trials.standard_deviation, 10.1, 0.05);
    EXPECT_NEAR(trials.high, 17.0, 0.1);
    std::vector<Contribution> parts(4, {.value = 1, .degrees_of_freedom = 1e9});
    parts.back().value = 10;
    EXPECT_NEAR(combined(parts).expanded_uncertainty(), 19.9, 0.05);
}

// JCGM 101, 9.3, calibration of a mass: a product of deviations, whose standard uncertainty to the first order, 0.0539
// mg, lacks what the trials have, 0.0755 mg.
TEST(Budget, TrialsShowWhatALinearModelLacks) {
    const Uncertainty mass{.inputs = {input(Distribution::normal, 0.050),                     // mg
                                      input(Distribution::normal, 0.020),                     // mg
                                      input(Distribution::rectangular, 0.1 / std::sqrt(3.0)), // kg/m^3
                                      input(Distribution::rectangular, 1000 / std::sqrt(3.0)),
                                      input(Distribution::rectangular, 50 / std::sqrt(3.0))}};
    const auto deviation = [](const std::vector<double>& d) {
        const double air = 1.20 + d[2], weight = 8000 + d[3], reference = 8000 + d[4];
        return (100000.000 + d[0] + 1.234 + d[1]) * (1 + (air - 1.2) * (1 / weight - 1 / reference)) - 100000;
    };
    const auto trials = of_trials(mass, 200000, deviation);
    EXPECT_NEAR(trials.mean, 1.2340, 0.001);
    EXPECT_NEAR(trials.standard_deviation, 0.0755, 0.0005);
    EXPECT_NEAR(trials.low, 1.0834, 0.002);
    EXPECT_NEAR(trials.high, 1.3825, 0.002);
    const std::vector<Contribution> parts = {{.value = 0.050, .degrees_of_freedom = 1e9},
                                             {.value = 0.020, .degrees_of_freedom = 1e9}};
    EXPECT_NEAR(combined(parts).standard_uncertainty, 0.0539, 0.0001);
}

// JCGM 100, H.1: the end gauge's effective degrees of freedom are 16 and its U for 99 % 93 nm with u = 32 nm. Here the
// contributions of table H.1 with their degrees of freedom.
TEST(Budget, EffectiveDegreesOfFreedomAreThoseOfTheEndGauge) {
    const double none = std::numeric_limits<double>::infinity();
    const std::vector<Contribution> parts = {{25, 18}, {5.8, 24}, {3.9, 5}, {6.7, 8}, {2.9, 50}, {16.6, 2}, {0, none}};
    const auto found = combined(parts);
    EXPECT_NEAR(found.standard_uncertainty, 32, 0.5);
    EXPECT_NEAR(std::floor(found.degrees_of_freedom), 16, 1);
}

// JCGM 101, 7.9.2.
TEST(Budget, TolerancesAreHalfOfTheLastDigit) {
    EXPECT_DOUBLE_EQ(numerical_tolerance(0.00035, 2), 0.000005);
    EXPECT_DOUBLE_EQ(numerical_tolerance(0.2, 1), 0.05);
    EXPECT_DOUBLE_EQ(numerical_tolerance(35, 2), 0.5);
    EXPECT_DOUBLE_EQ(numerical_tolerance(0.0996, 2), 0.005); // 0.10
}

TEST(Budget, EveryDistributionHasItsStandardUncertaintyAndEnds) {
    struct Case {
        Distribution distribution;
        double deviation, quantile; // of 97.5 %
    };
    const double even = std::sqrt(3.0) * 0.95, triangle = std::sqrt(6.0) * (1 - std::sqrt(0.05)),
                 sine = std::sqrt(2.0) * std::sin(0.5 * 3.14159265 * 0.95);
    for (const auto& [distribution, deviation, quantile] :
         {Case{Distribution::normal, 1, 1.96}, Case{Distribution::rectangular, 1, even},
          Case{Distribution::triangular, 1, triangle}, Case{Distribution::arcsine, 1, sine},
          Case{Distribution::student, std::sqrt(10.0 / 8), 2.228}}) {
        const Uncertainty one{.inputs = {input(distribution, 3, 10)}};
        const auto trials = of_trials(one, 100000, sum);
        EXPECT_NEAR(trials.standard_deviation, 3 * deviation, 0.04) << static_cast<int>(distribution);
        EXPECT_NEAR(trials.high, 3 * quantile, 0.08) << static_cast<int>(distribution);
        EXPECT_NEAR(trials.mean, 0, 0.04) << static_cast<int>(distribution);
    }
}

// Two inputs of correlation 0.8 have a sum of variance 3.6 and a difference of variance 0.4.
TEST(Budget, CorrelatedInputsDeviateTogether) {
    Uncertainty two{.inputs = std::vector(2, input(Distribution::normal, 1)),
                    .correlations = {{.first = 0, .second = 1, .coefficient = 0.8}}};
    const auto difference = [](const std::vector<double>& d) { return d[0] - d[1]; };
    EXPECT_NEAR(of_trials(two, 50000, sum).standard_deviation, std::sqrt(3.6), 0.03);
    EXPECT_NEAR(of_trials(two, 50000, difference).standard_deviation, std::sqrt(0.4), 0.01);
    const std::vector<Contribution> parts(2, {.value = 1, .degrees_of_freedom = 1e9});
    EXPECT_NEAR(combined(parts, two.correlations).standard_uncertainty, std::sqrt(3.6), 1e-9);
    // As JCGM 100, 5.2.2 has it, inputs may be one and the same.
    for (const double sign : {1.0, -1.0}) {
        two.correlations = {{.first = 0, .second = 1, .coefficient = sign}};
        EXPECT_NEAR(of_trials(two, 5000, sum).standard_deviation, sign > 0 ? 2 : 0, 0.1);
        EXPECT_NEAR(of_trials(two, 5000, difference).standard_deviation, sign > 0 ? 0 : 2, 0.1);
    }
    // Three that contradict each other have no distribution.
    two.inputs.push_back(two.inputs.front());
    two.correlations = {{0, 1, 0.9}, {1, 2, 0.9}, {0, 2, -0.9}};
    EXPECT_THROW(InputDraws(two, 1), InputError);
}

TEST(Budget, MoreTrialsLeaveTheFirstOnesAsTheyWere) {
    const Uncertainty two{.inputs = {input(Distribution::normal, 1), input(Distribution::arcsine, 2)}};
    const InputDraws draws(two, 3), again(two, 3), other(two, 4);
    (void)again.deviations(9);
    EXPECT_EQ(draws.deviations(5), again.deviations(5));
    EXPECT_NE(draws.deviations(5), other.deviations(5));
    EXPECT_NE(draws.deviations(5), draws.deviations(6));
}

} // namespace
} // namespace vkfv::measurement
