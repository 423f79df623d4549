// The robust areal Gaussian regression filter of ISO 16610-71.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The Gaussian low-pass of filter.hpp with a weight for each point: (1 - (r / c)^2)^2 if its residual r is less than c,
// else 0, with c = 4.4478 times the median of |r|, so that a spike or a hole has no influence. The regression is of
// degree zero (a mean, so form is removed before). It is repeated until c changes by less than a ten thousandth, at
// most 50 times. `nesting_index` in mm, positive (std::invalid_argument). Not-measured points stay so. A point around
// which all weights are zero keeps the value of the previous iteration.
HeightMap robust_gaussian_low_pass(const HeightMap& map, double nesting_index);

} // namespace vkfv::surface
