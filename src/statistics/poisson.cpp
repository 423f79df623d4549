#include "statistics/poisson.hpp"

#include "core/mathematics/units.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace vkfv::statistics {

namespace {

constexpr double least_mean_of_rejection = 10;

// Sums the distribution function until it exceeds a uniform number.
double by_inversion(double mean, RandomStream& random) {
    const double uniform = random.uniforms()[0];
    double count = 0, probability = std::exp(-mean), sum = probability;
    // If rounding leaves the sum below the number, the loop ends where the terms vanish.
    while (uniform > sum && probability > 0) {
        count += 1;
        probability *= mean / count;
        sum += probability;
    }
    return count;
}

// log(n!) minus Stirling's formula, for n >= 10: the error of four terms is below 1e-12.
double stirling_remainder(double n) {
    const double square = n * n;
    return (1.0 / 12 - (1.0 / 360 - (1.0 / 1260 - 1.0 / 1680 / square) / square) / square) / n;
}

// The rejection method with Hörmann's names of variables.
double by_rejection(double mean, RandomStream& random) {
    const double b = 0.931 + 2.53 * std::sqrt(mean);
    const double a = -0.059 + 0.02483 * b;
    const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
    const double v_r = 0.9277 - 3.6224 / (b - 2);
    for (;;) {
        const auto [first, v] = random.uniforms();
        const double u = first - 0.5;
        const double u_s = 0.5 - std::abs(u);
        const double count = std::floor((2 * a / u_s + b) * u + mean + 0.43);
        if (u_s >= 0.07 && v <= v_r) {
            return count;
        }
        if (count < 0 || (u_s < 0.013 && v > u_s)) {
            continue;
        }
        if (std::log(v * inverse_alpha / (a / (u_s * u_s) + b)) <= log_poisson_probability(count, mean)) {
            return count;
        }
    }
}

} // namespace

double poisson_count(double mean, RandomStream& random) {
    if (!(mean > 0)) {
        return 0;
    }
    return mean < least_mean_of_rejection ? by_inversion(mean, random)
                                          : by_rejection(std::min(mean, largest_mean), random);
}

double log_poisson_probability(double count, double mean) {
    constexpr std::array factorials = {1.0, 1.0, 2.0, 6.0, 24.0, 120.0, 720.0, 5040.0, 40320.0, 362880.0};
    if (count < static_cast<double>(factorials.size())) {
        return count * std::log(mean) - mean - std::log(factorials[static_cast<std::size_t>(count)]);
    }
    const double excess = (count - mean) / mean;
    const double deviance = mean * ((1 + excess) * std::log1p(excess) - excess);
    return -deviance - 0.5 * std::log(2 * pi * count) - stirling_remainder(count);
}

} // namespace vkfv::statistics
