#include "measurement/budget/input_draws.hpp"

#include "statistics/correlation_root.hpp"
#include "statistics/random_stream.hpp"

#include <boost/math/distributions/students_t.hpp>

#include <cmath>
#include <numbers>

namespace vkfv::measurement {

InputDraws::InputDraws(const Uncertainty& uncertainty, std::uint32_t seed) : uncertainty_(uncertainty), seed_(seed) {
    const std::size_t count = uncertainty_.inputs.size();
    std::vector<double> correlation(count * count);
    for (std::size_t k = 0; k < count; ++k) {
        correlation[k * count + k] = 1;
    }
    for (const auto& one : uncertainty_.correlations) {
        correlation[one.first * count + one.second] = correlation[one.second * count + one.first] = one.coefficient;
    }
    auto root = statistics::correlation_root(correlation, count);
    if (!root) {
        throw InputError(
            {.where = {},
             .key = "uncertainty.correlation",
             .found = "coefficients that contradict each other",
             .expected = "correlations that all keys can have at once",
             .remedy = "Lower a coefficient: what two keys share with a third they share with each other."});
    }
    root_ = std::move(*root);
}

std::vector<double> InputDraws::deviations(std::uint32_t trial) const {
    using Distribution = UncertainInput::Distribution;
    const std::size_t count = uncertainty_.inputs.size();
    std::vector<double> uniforms(count), others(count), normals(count);
    for (std::size_t k = 0; k < count; ++k) {
        statistics::RandomStream random(seed_, trial, static_cast<std::uint32_t>(k), 0,
                                        statistics::Purpose::uncertain_input);
        const auto [first, second] = random.uniforms();
        uniforms[k] = first;
        others[k] = second;
        normals[k] = random.normal();
    }
    std::vector<double> deviations(count);
    for (std::size_t k = 0; k < count; ++k) {
        const UncertainInput& input = uncertainty_.inputs[k];
        double standard = 0; // of a distribution whose standard uncertainty is 1
        switch (input.distribution) {
        case Distribution::normal:
            for (std::size_t other = 0; other < count; ++other) {
                standard += root_[k * count + other] * normals[other];
            }
            break;
        case Distribution::student:
            standard = boost::math::quantile(boost::math::students_t(input.degrees_of_freedom), uniforms[k]);
            break;
        case Distribution::rectangular:
            standard = std::sqrt(3.0) * (2 * uniforms[k] - 1);
            break;
        case Distribution::triangular: // a sum of two even distributions
            standard = std::sqrt(6.0) * (uniforms[k] + others[k] - 1);
            break;
        case Distribution::arcsine:
            standard = std::numbers::sqrt2 * std::sin(2 * std::numbers::pi * uniforms[k]);
            break;
        }
        deviations[k] = input.uncertainty * standard;
    }
    return deviations;
}

} // namespace vkfv::measurement
