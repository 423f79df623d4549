// The C++ side of pixel.glsl and interface.glsl.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#define VKFV_FUNCTION inline
#define VKFV_PRECISE

namespace vkfv::estimate {

using std::max;
using std::sqrt;
using std::uint64_t;
using uint = std::uint32_t;
#include "estimate/pixel.glsl"

#include "estimate/interface.glsl"
static_assert(sizeof(EstimatedPixels) == 96); // scalar layout, as the kernel has it

} // namespace vkfv::estimate

#undef VKFV_FUNCTION
#undef VKFV_PRECISE
