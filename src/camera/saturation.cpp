#include "camera/saturation.hpp"

#include "statistics/poisson.hpp"

#include <cmath>

namespace vkfv::camera {

namespace {

// The probability P(N < n) of a Poisson variable, summed over the smaller of the two tails.
double probability_below(double n, double mean) {
    constexpr double negligible = 1e-18;
    if (n <= 0) {
        return 0;
    }
    if (n - 1 > mean) { // sums the small upper tail
        double term = std::exp(statistics::log_poisson_probability(n, mean)), above = 0;
        for (double k = n; term > negligible * above && term > 0; k += 1, term *= mean / k) {
            above += term;
        }
        return 1 - above;
    }
    double term = std::exp(statistics::log_poisson_probability(n - 1, mean)), below = 0;
    for (double k = n - 1; k >= 0 && term > negligible * below; term *= k / mean, k -= 1) {
        below += term;
    }
    return below;
}

double slope_over_responses(double capacity, double photo_response, double clip) {
    if (photo_response <= 0) {
        return variance_slope(capacity, clip);
    }
    constexpr double reach = 4; // in standard deviations
    constexpr int nodes_a_side = 16;
    double slope = 0;
    for (int node = -nodes_a_side; node <= nodes_a_side; ++node) {
        const double deviation = reach * node / nodes_a_side;
        const double response = 1 + photo_response * deviation;
        if (response > 0) {
            slope += std::exp(-0.5 * deviation * deviation) * response * variance_slope(capacity * response, clip);
        }
    }
    return slope;
}

} // namespace

double variance_slope(double mean, double clip) {
    const double below = probability_below(clip, mean), further_below = probability_below(clip - 1, mean);
    const double charge_below = mean * further_below; // sum over n < C of n p(n)
    const double charge = charge_below + clip * (1 - below);
    return 2 * charge_below + below - 2 * charge * below;
}

double clip_of_capacity(double capacity, double photo_response) {
    const double spread = std::sqrt(capacity + photo_response * photo_response * capacity * capacity);
    double low = std::floor(capacity - spread), high = std::ceil(capacity + 10 * spread) + 10;
    while (high - low > 1) {
        const double middle = std::floor((low + high) / 2);
        (slope_over_responses(capacity, photo_response, middle) >= 0 ? high : low) = middle;
    }
    return high;
}

} // namespace vkfv::camera
