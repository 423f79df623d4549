// The C++ side of interface.glsl.
#pragma once

#include <cstdint>

namespace vkfv::fields::kernels {

using std::uint64_t;
using uint = std::uint32_t;
#include "fields/interface.glsl"
static_assert(sizeof(FieldBatch) == 128); // scalar layout, as the kernels have it; Vulkan guarantees no more
static_assert(sizeof(FieldFrames) == 48);

} // namespace vkfv::fields::kernels
