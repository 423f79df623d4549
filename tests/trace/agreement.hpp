// A test of whether two images are one in expectation.
#pragma once

#include "support/statistics.hpp"
#include "trace/interface/tracer.hpp"

#include <cmath>
#include <cstddef>
#include <numeric>

namespace vkfv::test {

inline double total(const Grid<double>& grid) {
    return std::accumulate(grid.values.begin(), grid.values.end(), 0.0);
}

// The p-value that all pixels have one expectation. The errors' squares are shared out as the light is, since that of
// one pixel is known badly.
inline double agreement(const trace::Image& one, const trace::Image& other) {
    const auto variance_per_flux = [](const trace::Image& image) {
        double squares = 0;
        for (const double error : image.standard_error.values) {
            squares += error * error;
        }
        return squares / total(image.flux);
    };
    const double variance = variance_per_flux(one) + variance_per_flux(other);
    double chi_square = 0;
    for (std::size_t k = 0; k < one.flux.values.size(); ++k) {
        const double mean = 0.5 * (one.flux.values[k] + other.flux.values[k]);
        chi_square += std::pow(one.flux.values[k] - other.flux.values[k], 2) / (variance * mean);
    }
    return chi_square_tail(chi_square, static_cast<double>(one.flux.values.size()));
}

} // namespace vkfv::test
