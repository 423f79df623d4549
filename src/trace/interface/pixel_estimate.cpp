#include "trace/interface/pixel_estimate.hpp"

#include "core/threads/parallel_rows.hpp"

#include <numeric>

namespace vkfv::trace {

namespace {

using namespace estimate;

PixelEstimate estimate_of(const EstimateRule& rule, std::span<const std::uint64_t> numbers, std::size_t stride,
                          std::size_t pixel) {
    const auto number = [&](std::size_t place) { return static_cast<double>(numbers[place]); };
    if (rule.kind == ESTIMATE_COUNTS) {
        return estimate_of_rays(rule, number(pixel), number(pixel));
    }
    if (rule.kind == ESTIMATE_WEIGHTS) {
        return estimate_of_rays(rule, rule.unit * number(2 * pixel), rule.unit_of_squares * number(2 * pixel + 1));
    }
    MeanSums sums{0, 0};
    for (std::size_t randomisation = 0; static_cast<double>(randomisation) < rule.count; ++randomisation) {
        sums = with_randomisation(rule, sums, number(randomisation * stride + pixel));
    }
    return estimate_of_randomisations(rule, sums);
}

} // namespace

PixelLight estimate_pixels(const EstimateRule& rule, ImageSize pixels, std::span<const std::uint64_t> numbers,
                           std::size_t stride) {
    PixelLight light{Grid<double>(pixels.columns, pixels.rows), Grid<double>(pixels.columns, pixels.rows)};
    parallel_rows(pixels.columns, pixels.rows, [&](int first_row, int end_row) {
        const std::size_t end = light.flux.index(0, end_row);
        for (std::size_t pixel = light.flux.index(0, first_row); pixel < end; ++pixel) {
            const PixelEstimate one = estimate_of(rule, numbers, stride, pixel);
            light.flux.values[pixel] = one.flux;
            light.standard_error.values[pixel] = one.standard_error;
        }
    });
    return light;
}

double sum_of(std::span<const double> pixels) {
    return std::accumulate(pixels.begin(), pixels.end(), 0.0);
}

} // namespace vkfv::trace
