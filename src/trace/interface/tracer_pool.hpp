// A pool of devices that trace the images of one stack together.
#pragma once

#include "trace/interface/tracer.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace vkfv::trace {

// Rays of about a second on a fast GPU: the parts' numbers are added on the host, which takes its time too.
inline constexpr std::uint64_t least_parted_rays = std::uint64_t{1} << 33;

// A tracer that gives each image to a free tracer of the pool, and an image of at least `least_parted` rays in parts to
// all of them; the bits are the same. tracers: all of one identity, at least one. A device's failure is thrown by the
// futures of its images, as a vulkan::DeviceFailure with its place. Parted exposures save no checkpoints.
std::unique_ptr<Tracer> make_tracer_pool(std::vector<std::unique_ptr<Tracer>> tracers,
                                         std::uint64_t least_parted = least_parted_rays);

// Rethrows the current exception; if it is a device's failure, as the failure of the device at this place.
[[noreturn]] void rethrow_as_failure_of(int place);

} // namespace vkfv::trace
