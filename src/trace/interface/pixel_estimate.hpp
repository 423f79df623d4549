// From the numbers that were counted to the light of each pixel: on the host, to the bits of DeviceEstimate.
#pragma once

#include "core/mathematics/grid.hpp"
#include "core/mathematics/pixel_grid.hpp"
#include "estimate/estimate.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace vkfv::trace {

struct PixelLight {
    Grid<double> flux;           // W
    Grid<double> standard_error; // W
};

// numbers: as the rule says; of randomisations, each has `stride` numbers, no fewer than pixels.
PixelLight estimate_pixels(const estimate::EstimateRule& rule, ImageSize pixels, std::span<const std::uint64_t> numbers,
                           std::size_t stride = 0);

// Of all pixels, in their order, for the same bits on any number of cores.
double sum_of(std::span<const double> pixels);

} // namespace vkfv::trace
