// Several devices at work on the images of one stack.
#pragma once

#include "trace/interface/tracer.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace vkfv::trace {

// About a second's on a fast GPU: the parts' numbers are added on the host, which takes its time too.
inline constexpr std::uint64_t least_parted_rays = std::uint64_t{1} << 33;

// A tracer that gives each image to whichever of these is free, and an image of at least so many rays in parts to all
// of them; the bits are the same. All of one identity, at least one. A device that fails shows in the futures of the
// images that it had, as a vulkan::DeviceFailure with its place. Parted exposures keep no checkpoints.
std::unique_ptr<Tracer> make_tracer_pool(std::vector<std::unique_ptr<Tracer>> tracers,
                                         std::uint64_t least_parted = least_parted_rays);

// The calling code's exception as a failure of the device at this place, if a device's failure is what it is.
[[noreturn]] void rethrow_as_failure_of(int place);

} // namespace vkfv::trace
