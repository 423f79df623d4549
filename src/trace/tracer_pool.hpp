// Several devices at work on the images of one stack.
#pragma once

#include "trace/tracer.hpp"

#include <memory>
#include <vector>

namespace vkfv::trace {

// A tracer that gives each image to whichever of these is free; all of one identity, at least one. A device that fails
// shows in the futures of the images that it had, as a vulkan::DeviceFailure with its place.
std::unique_ptr<Tracer> make_tracer_pool(std::vector<std::unique_ptr<Tracer>> tracers);

// The calling code's exception as a failure of the device at this place, if a device's failure is what it is.
[[noreturn]] void rethrow_as_failure_of(int place);

} // namespace vkfv::trace
