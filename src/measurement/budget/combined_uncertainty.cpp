#include "measurement/budget/combined_uncertainty.hpp"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace vkfv::measurement {

namespace {

constexpr double probability = 0.95;

} // namespace

CombinedUncertainty combined(std::span<const Contribution> contributions,
                             std::span<const Uncertainty::Correlation> correlations) {
    constexpr double as_good_as_normal = 1e6;
    double variance = 0, of_freedom = 0;
    for (const auto& [value, freedom] : contributions) {
        variance += value * value;
        of_freedom += std::pow(value, 4) / freedom;
    }
    for (const auto& [first, second, coefficient] : correlations) {
        variance += 2 * coefficient * contributions[first].value * contributions[second].value;
    }
    CombinedUncertainty result{.standard_uncertainty = std::sqrt(std::max(0.0, variance))};
    result.degrees_of_freedom =
        of_freedom > 0 ? variance * variance / of_freedom : std::numeric_limits<double>::infinity();
    const boost::math::students_t student(std::clamp(result.degrees_of_freedom, 1.0, as_good_as_normal));
    result.coverage_factor = boost::math::quantile(student, 0.5 * (1 + probability));
    return result;
}

TrialStatistics statistics_of(std::vector<double> values) {
    std::ranges::sort(values);
    const auto count = static_cast<double>(values.size());
    TrialStatistics result{.trials = static_cast<int>(values.size())};
    result.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
    double squares = 0;
    for (const double value : values) {
        squares += (value - result.mean) * (value - result.mean);
    }
    result.standard_deviation = std::sqrt(squares / (count - 1));
    // q of the M values lie in the interval, as many below it as above.
    const double within = probability * count, below = 0.5 * (count - within);
    const auto at = [&](double place) {
        return values[static_cast<std::size_t>(std::clamp(std::floor(place + 0.5), 1.0, count)) - 1];
    };
    result.low = at(below);
    result.high = at(below + within);
    // The variance of a sample's quantile is p (1 - p) / (M f^2), f the density there (a normal one here).
    const double tail = 0.5 * (1 - probability);
    const boost::math::normal standard;
    const double density = boost::math::pdf(standard, boost::math::quantile(standard, tail));
    result.end_uncertainty = result.standard_deviation * std::sqrt(tail * (1 - tail) / count) / density;
    return result;
}

double numerical_tolerance(double uncertainty, int digits) {
    double last = std::pow(10.0, std::floor(std::log10(uncertainty)) - (digits - 1));
    if (std::round(uncertainty / last) >= std::pow(10.0, digits)) { // 0.0996 with two digits is 0.10
        last *= 10;
    }
    return 0.5 * last;
}

} // namespace vkfv::measurement
