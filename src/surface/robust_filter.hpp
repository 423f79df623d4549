// The robust areal Gaussian regression filter of ISO 16610-71.
#pragma once

#include "surface/height_map.hpp"

namespace vkfv::surface {

// The Gaussian low-pass of filter.hpp with a weight for each point, (1 - (r / c)^2)^2 where its residual r is less than
// c and 0 beyond, c = 4.4478 times the median of |r|: a spike or a hole takes no part. The regression is of degree zero
// (a mean, so that form is removed before). It is repeated until c changes by less than a ten thousandth, at most 50
// times. `nesting_index` in mm, positive (std::invalid_argument). Not-measured points stay so. A point around which
// nothing has weight keeps the value of the iteration before.
HeightMap robust_gaussian_low_pass(const HeightMap& map, double nesting_index);

} // namespace vkfv::surface
