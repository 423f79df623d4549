// Counts of independent events, such as electrons.
#pragma once

#include "statistics/random_stream.hpp"

namespace vkfv::statistics {

// A number from a Poisson distribution, exact at every mean: by inversion below 10, above by W. Hörmann's transformed
// rejection with squeeze, "The transformed rejection method for generating Poisson random variables", Insurance:
// Mathematics and Economics 12 (1993) 39-45. Means above `largest_mean` (light that saturates every camera) are
// replaced by it.
double poisson_count(double mean, RandomStream& random);
inline constexpr double largest_mean = 1e12;

// The logarithm of the probability of a count, decomposed as by C. Loader, "Fast and accurate computation of binomial
// probabilities" (2000), to avoid cancellation at large means. mean > 0.
double log_poisson_probability(double count, double mean);

} // namespace vkfv::statistics
