// Each pixel's flux and standard error from counted numbers, on the host, to the same bits as DeviceEstimate.
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

// Makes the estimates. numbers: as the rule defines them; each randomisation has `stride` numbers, at least the number
// of pixels.
PixelLight estimate_pixels(const estimate::EstimateRule& rule, ImageSize pixels, std::span<const std::uint64_t> numbers,
                           std::size_t stride = 0);

// The sum over all pixels in their order, so that its bits do not depend on the number of cores.
double sum_of(std::span<const double> pixels);

} // namespace vkfv::trace
