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

// Of 400 intervals of 95 %, 380 +- 4.4 hold; 3.5 standard deviations of that are 365 to 395. The truth is not the point
// of the runs.
TEST(SimulatedMoments, IntervalsHoldTheParametersAsOftenAsTheySay) {
    constexpr int draws = 400;
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
        EXPECT_GE(held[k], 365) << k;
        EXPECT_LE(held[k], 395) << k;
        EXPECT_LE(std::sqrt(variance[k] / best), 1.5) << k;
        EXPECT_GE(std::sqrt(variance[k] / best), 1.0) << k;
        EXPECT_NEAR(std::sqrt(stated_bound[k] / best), 1, 0.2) << k;
        printf("%zu held %d ratio %.3f stated bound %.3f\n", k, held[k], std::sqrt(variance[k] / best),
               std::sqrt(stated_bound[k] / best));
    }
    printf("twin %d misfit %.3f rejected %d\n", held_without_neighbours, misfit, rejected);
    EXPECT_LT(held_without_neighbours, 350);
    EXPECT_NEAR(misfit, 1, 0.1);
    EXPECT_LE(rejected, 40); // 20 +- 4.4 are expected
}

} // namespace of_simulated_moments
} // namespace
} // namespace vkfv::statistics
