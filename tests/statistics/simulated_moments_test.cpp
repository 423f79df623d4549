// Fits by simulated moments hold their parameters as often as they say, on a model whose covariance is known.
#include "statistics/simulated_moments.hpp"

#include <boost/math/distributions/students_t.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace vkfv::statistics {
namespace {
namespace of_simulated_moments { // files of a unity build share the unnamed namespace

using Vector = std::vector<double>;

// Statistics along a scan: neighbours scatter alike, as those of focus curves do, by an autoregression of order one.
// The first parameter raises a peak in the middle; the second widens it, or for `alike` nearly does what the first
// does.
struct KnownModel {
    std::size_t statistics = 40;
    double neighbours = 0.8; // correlation of neighbours
    bool alike = false;

    double place(std::size_t k) const {
        return (static_cast<double>(k) - 0.5 * static_cast<double>(statistics - 1)) /
               (0.15 * static_cast<double>(statistics));
    }
    double mean(std::size_t k, double height, double width) const {
        const double z = place(k);
        if (alike) {
            return 5 * (height + width) * std::exp(-0.5 * z * z) + 0.05 * width * z;
        }
        return 5 * std::exp(height) * std::exp(-0.5 * z * z * std::exp(-2 * width));
    }
    // A run of a seed; the same seed has the same noise whatever the parameters are.
    Vector run(double height, double width, unsigned seed) const {
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal;
        Vector values(statistics);
        double noise = normal(random);
        for (std::size_t k = 0; k < statistics; ++k) {
            values[k] = mean(k, height, width) + noise;
            noise = neighbours * noise + std::sqrt(1 - neighbours * neighbours) * normal(random);
        }
        return values;
    }
};

ModelRuns runs_of(const KnownModel& model, std::size_t seeds, unsigned first, double step = 0.1) {
    ModelRuns runs{.steps = {step, step}, .widths = {10, 10}};
    runs.above.resize(2);
    runs.below.resize(2);
    for (std::size_t k = 0; k < seeds; ++k) {
        const unsigned seed = first + static_cast<unsigned>(k);
        runs.pilot.push_back(model.run(0, 0, seed + 200u));
        runs.centre.push_back(model.run(0, 0, seed));
        runs.above[0].push_back(model.run(step, 0, seed));
        runs.below[0].push_back(model.run(-step, 0, seed));
        runs.above[1].push_back(model.run(0, step, seed));
        runs.below[1].push_back(model.run(0, -step, seed));
    }
    return runs;
}

// Variances of the best unbiased estimates of both parameters: the inverse of J^T C^-1 J. The inverse of the covariance
// of an autoregression has three diagonals.
std::pair<double, double> bounds_of(const KnownModel& model) {
    const double step = 1e-4, r = model.neighbours;
    std::vector<std::pair<double, double>> slopes;
    for (std::size_t k = 0; k < model.statistics; ++k) {
        slopes.emplace_back((model.mean(k, step, 0) - model.mean(k, -step, 0)) / (2 * step),
                            (model.mean(k, 0, step) - model.mean(k, 0, -step)) / (2 * step));
    }
    double aa = slopes[0].first * slopes[0].first, ab = slopes[0].first * slopes[0].second,
           bb = slopes[0].second * slopes[0].second;
    for (std::size_t k = 1; k < slopes.size(); ++k) { // what is new in a statistic beside its neighbour
        const double a = (slopes[k].first - r * slopes[k - 1].first) / std::sqrt(1 - r * r);
        const double b = (slopes[k].second - r * slopes[k - 1].second) / std::sqrt(1 - r * r);
        aa += a * a;
        ab += a * b;
        bb += b * b;
    }
    const double determinant = aa * bb - ab * ab;
    return {bb / determinant, aa / determinant};
}

// Half of the 95 % interval, in standard deviations.
double half_interval(double degrees_of_freedom) {
    return boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.975);
}

// 200 intervals of 95 % hold 190 +- 3.1 times; the test allows 3.5 of these standard deviations, 179 to 200. The truth
// is not the point about which the model was run.
TEST(SimulatedMoments, IntervalsHoldTheParametersAsOftenAsTheySay) {
    constexpr int draws = 200;
    constexpr std::size_t seeds = 24;
    constexpr double height = 0.05, width = -0.04;
    const KnownModel model;
    const auto bound = bounds_of(model);
    int held[2] = {0, 0}, held_without_neighbours = 0;
    double variance[2] = {0, 0}, stated_bound[2] = {0, 0}, misfit = 0;
    int rejected = 0;
    for (int draw = 0; draw < draws; ++draw) {
        const auto runs = runs_of(model, seeds, 1000u * static_cast<unsigned>(draw + 1));
        const auto fit =
            fit_moments(runs, model.run(height, width, 7u + 1000u * static_cast<unsigned>(draw + 1) + 500u));
        ASSERT_TRUE(fit.determined[0] && fit.determined[1]);
        ASSERT_EQ(fit.bound.rows, 2u);
        const double half = half_interval(fit.degrees_of_freedom);
        const double truth[2] = {height, width};
        for (std::size_t k = 0; k < 2; ++k) {
            held[k] += std::abs(fit.change[k] - truth[k]) <= half * std::sqrt(fit.covariance(k, k)) ? 1 : 0;
            variance[k] += fit.covariance(k, k) / draws;
            stated_bound[k] += fit.bound(k, k) / draws;
        }
        misfit += fit.misfit / draws;
        rejected += fit.misfit_probability < 0.05 ? 1 : 0;
        // The wrong twin takes statistics for independent: its variance is that of least squares by single variances.
        double square = 0;
        for (std::size_t k = 0; k < model.statistics; ++k) {
            const double slope = (model.mean(k, 1e-4, 0) - model.mean(k, -1e-4, 0)) / 2e-4;
            square += slope * slope;
        }
        held_without_neighbours += std::abs(fit.change[0] - height) <= half / std::sqrt(square) ? 1 : 0;
    }
    for (std::size_t k = 0; k < 2; ++k) {
        const double best = k == 0 ? bound.first : bound.second;
        EXPECT_GE(held[k], 179) << k;
        EXPECT_LT(held[k], draws) << k; // intervals that are too long hold always
        EXPECT_LE(std::sqrt(variance[k] / best), 1.5) << k;
        EXPECT_GE(std::sqrt(variance[k] / best), 1.0) << k;
        EXPECT_NEAR(std::sqrt(stated_bound[k] / best), 1, 0.2) << k;
    }
    EXPECT_LT(held_without_neighbours, 150);
    EXPECT_NEAR(misfit, 1, 0.1);
    EXPECT_LE(rejected, 20); // 10 +- 3.1 are expected
}

TEST(SimulatedMoments, ParametersThatDoAlikeAreCorrelated) {
    KnownModel model;
    model.alike = true;
    const auto fit = fit_moments(runs_of(model, 24, 1), model.run(0.03, -0.03, 900));
    const double correlation = fit.covariance(0, 1) / std::sqrt(fit.covariance(0, 0) * fit.covariance(1, 1));
    EXPECT_LT(correlation, -0.95);
    // Their sum is told far better than either, as the covariance knows.
    const double sum = fit.covariance(0, 0) + fit.covariance(1, 1) + 2 * fit.covariance(0, 1);
    EXPECT_LT(sum, 0.1 * fit.covariance(0, 0));
    EXPECT_LT(fit_moments(runs_of(KnownModel(), 24, 1), KnownModel().run(0, 0, 900)).covariance(0, 1) /
                  std::sqrt(fit.covariance(0, 0) * fit.covariance(1, 1)),
              0.95);
}

// A parameter without effect differs only by noise, which the halves of the seeds do not share.
TEST(SimulatedMoments, AParameterWithoutEffectIsNotDetermined) {
    const KnownModel model;
    auto runs = runs_of(model, 24, 1);
    runs.widths[1] = 0.1;
    for (std::size_t seed = 0; seed < 24; ++seed) {
        runs.above[1][seed] = model.run(0, 0, 5000u + static_cast<unsigned>(seed));
        runs.below[1][seed] = model.run(0, 0, 6000u + static_cast<unsigned>(seed));
    }
    const auto fit = fit_moments(runs, model.run(0.05, 0, 900));
    EXPECT_TRUE(fit.determined[0]);
    EXPECT_FALSE(fit.determined[1]);
    EXPECT_EQ(fit.change[1], 0);
    EXPECT_EQ(fit.covariance(1, 1), 0);
    EXPECT_NEAR(fit.change[0], 0.05, 4 * std::sqrt(fit.covariance(0, 0)));
}

// Where no parameter moves anything, or all move the same, nothing is determined; a variance of 0 would be a lie.
TEST(SimulatedMoments, NothingIsDeterminedWithoutEffectsOrByEqualOnes) {
    const KnownModel model;
    const auto measured = model.run(0.05, 0, 900);
    auto runs = runs_of(model, 24, 1);
    auto equal = runs;
    for (std::size_t k = 0; k < 2; ++k) {
        runs.above[k] = runs.below[k] = runs.centre;
    }
    const auto without = fit_moments(runs, measured);
    equal.above[1] = equal.above[0];
    equal.below[1] = equal.below[0];
    const auto by_equal = fit_moments(equal, measured);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_FALSE(without.determined[k]);
        EXPECT_FALSE(without.alike[k]);
        EXPECT_FALSE(by_equal.determined[k]);
        EXPECT_TRUE(by_equal.alike[k]);
        EXPECT_EQ(by_equal.change[k], 0);
    }
    EXPECT_EQ(without.bound.rows, 0u);
    EXPECT_TRUE(std::isfinite(without.misfit));
    EXPECT_FALSE(fit_moments(runs_of(model, 24, 1), measured).alike[0]);
}

// A parameter that is told a million times better than the other is no reason to take them for alike.
TEST(SimulatedMoments, ParametersOfVeryDifferentScalesAreBothDetermined) {
    const KnownModel model;
    const auto measured = model.run(0.05, 0.02, 900);
    const auto runs = runs_of(model, 24, 1);
    auto scaled = runs;
    scaled.steps[0] *= 1e-4;
    scaled.widths[0] *= 1e-4;
    scaled.steps[1] *= 1e4;
    scaled.widths[1] *= 1e4;
    const auto fit = fit_moments(runs, measured), of_scaled = fit_moments(scaled, measured);
    ASSERT_TRUE(of_scaled.determined[0] && of_scaled.determined[1]);
    EXPECT_NEAR(of_scaled.change[0] * 1e4, fit.change[0], 1e-9);
    EXPECT_NEAR(of_scaled.change[1] * 1e-4, fit.change[1], 1e-9);
}

// A wave that no parameter makes, of twice the scatter of a statistic, is a misfit; without it there is none.
TEST(SimulatedMoments, WhatTheModelDoesNotMakeIsAMisfit) {
    const KnownModel model;
    const auto runs = runs_of(model, 24, 1);
    auto measured = model.run(0.05, 0, 900);
    EXPECT_GT(fit_moments(runs, measured).misfit_probability, 0.05);
    for (std::size_t k = 0; k < measured.size(); ++k) {
        measured[k] += 2 * std::cos(2 * static_cast<double>(k));
    }
    const auto fit = fit_moments(runs, measured);
    EXPECT_LT(fit.misfit_probability, 0.05);
    EXPECT_GT(fit.misfit, 2);
}

TEST(SimulatedMoments, AStatisticThatNeverDiffersHasNoWeight) {
    const KnownModel model;
    auto runs = runs_of(model, 24, 1);
    auto measured = model.run(0.05, 0.02, 900);
    const auto without = fit_moments(runs, measured);
    for (auto* rows : {&runs.pilot, &runs.centre, &runs.above[0], &runs.above[1], &runs.below[0], &runs.below[1]}) {
        for (auto& row : *rows) {
            row.push_back(3);
        }
    }
    measured.push_back(4);
    const auto with = fit_moments(runs, measured);
    EXPECT_EQ(with.change, without.change);
    EXPECT_EQ(with.expected.back(), 3);
    EXPECT_EQ(with.deviation.back(), 0);
}

TEST(SimulatedMoments, RunsOfOtherShapesAreRefused) {
    const KnownModel model;
    const auto measured = model.run(0, 0, 900);
    EXPECT_THROW((void)fit_moments(runs_of(model, least_seeds(2) - 1, 1), measured), std::invalid_argument);
    auto runs = runs_of(model, least_seeds(2), 1);
    EXPECT_NO_THROW((void)fit_moments(runs, measured));
    runs.above[1][3].pop_back();
    EXPECT_THROW((void)fit_moments(runs, measured), std::invalid_argument);
    runs = runs_of(model, least_seeds(2), 1);
    for (auto& row : runs.pilot) {
        row = measured;
    }
    EXPECT_THROW((void)fit_moments(runs, measured), std::domain_error);
}

} // namespace of_simulated_moments
} // namespace
} // namespace vkfv::statistics
