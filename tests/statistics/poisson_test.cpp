// Electrons and normal deviates follow their distributions, computed otherwise: probabilities by std::lgamma, and
// Pearson's chi-square over 10^6 draws at each mean.
#include "statistics/poisson.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace vkfv::statistics {
namespace {

constexpr int draws = 1'000'000;

double probability(double count, double mean) {
    return std::exp(count * std::log(mean) - mean - std::lgamma(count + 1));
}

// Chi-square of counts in cells of at least 50 expected ones, less its mean, over its standard deviation.
double chi_square_excess(const std::vector<double>& observed, const std::vector<double>& expected) {
    double chi = 0, cells = 0, cell_observed = 0, cell_expected = 0;
    for (std::size_t k = 0; k < observed.size(); ++k) {
        cell_observed += observed[k];
        cell_expected += expected[k];
        if (cell_expected >= 50) {
            chi += (cell_observed - cell_expected) * (cell_observed - cell_expected) / cell_expected;
            cells += 1;
            cell_observed = cell_expected = 0;
        }
    }
    return (chi - (cells - 1)) / std::sqrt(2 * (cells - 1));
}

// The excess of chi-square, in standard deviations, of draws of `mean` held against the distribution of `claimed`.
double excess_of(double mean, double claimed) {
    const double reach = 7 * std::sqrt(mean) + 12;
    const auto first = static_cast<long>(std::max(0.0, std::floor(mean - reach)));
    const auto last = static_cast<long>(mean + reach);
    std::vector<double> observed(static_cast<std::size_t>(last - first + 1)), expected;
    for (int k = 0; k < draws; ++k) {
        RandomStream random(3, 5, static_cast<std::uint32_t>(k), 0, Purpose::temporal_noise);
        const auto count = static_cast<long>(poisson_count(mean, random));
        observed[static_cast<std::size_t>(std::clamp(count, first, last) - first)] += 1;
    }
    for (long count = first; count <= last; ++count) {
        expected.push_back(draws * probability(static_cast<double>(count), claimed));
    }
    return chi_square_excess(observed, expected);
}

TEST(Poisson, CountsHaveTheirDistribution) {
    for (const double mean : {0.02, 1.0, 9.9, 10.1, 300.0, 1e4, 1e6}) {
        EXPECT_LT(std::abs(excess_of(mean, mean)), 4) << mean;
    }
}

// The wrong twin: a mean that is off by a hundredth of a standard deviation is found.
TEST(Poisson, ChiSquareFindsAMeanThatIsOff) {
    EXPECT_GT(excess_of(300, 300 + 0.01 * std::sqrt(300.0)), 4);
}

TEST(Poisson, OfNoLightThereIsNothingAndOfTooMuchNothingBreaks) {
    RandomStream random(1, 1, 1, 1, Purpose::temporal_noise);
    EXPECT_EQ(poisson_count(0, random), 0);
    EXPECT_EQ(poisson_count(-1, random), 0);
    EXPECT_NEAR(poisson_count(1e30, random), largest_mean, 1e-5 * largest_mean);
}

TEST(Poisson, LogarithmsOfProbabilitiesAgreeWithThoseByLogarithmsOfTheGammaFunction) {
    for (const double mean : {0.3, 12.0, 5000.0}) {
        for (const double count : {0.0, 3.0, 9.0, 10.0, 40.0, 5100.0}) {
            const double wanted = count * std::log(mean) - mean - std::lgamma(count + 1);
            EXPECT_NEAR(log_poisson_probability(count, mean), wanted, 1e-10 * std::abs(wanted) + 1e-11);
        }
    }
}

TEST(RandomStream, NormalDeviatesHaveTheirDistribution) {
    constexpr int cells = 200;
    std::vector<double> observed(cells), expected(cells, double{draws} / cells);
    for (int k = 0; k < draws; ++k) {
        RandomStream random(3, 5, static_cast<std::uint32_t>(k), 0, Purpose::dark_signal);
        const double uniform = 0.5 * std::erfc(-random.normal() / std::numbers::sqrt2);
        observed[static_cast<std::size_t>(std::min(cells - 1.0, std::floor(uniform * cells)))] += 1;
    }
    EXPECT_LT(std::abs(chi_square_excess(observed, expected)), 4);
}

// Each of seed, image, pixel, frame and purpose has an effect.
TEST(RandomStream, EveryIndexMakesOtherNumbers) {
    const auto first = RandomStream(1, 2, 3, 4, Purpose::temporal_noise).uniforms();
    EXPECT_EQ(RandomStream(1, 2, 3, 4, Purpose::temporal_noise).uniforms(), first);
    EXPECT_NE(RandomStream(9, 2, 3, 4, Purpose::temporal_noise).uniforms(), first);
    EXPECT_NE(RandomStream(1, 9, 3, 4, Purpose::temporal_noise).uniforms(), first);
    EXPECT_NE(RandomStream(1, 2, 9, 4, Purpose::temporal_noise).uniforms(), first);
    EXPECT_NE(RandomStream(1, 2, 3, 9, Purpose::temporal_noise).uniforms(), first);
    EXPECT_NE(RandomStream(1, 2, 3, 4, Purpose::dark_signal).uniforms(), first);
}

} // namespace
} // namespace vkfv::statistics
