// A device's tracer of an instrument with several sources.
#pragma once

#include "trace/device/device_exposures.hpp"

#include <memory>
#include <vector>

namespace vkfv::trace {

// The tracer of all sources. tracers: one for each source, at least two, all on one device.
std::unique_ptr<DeviceExposures> mix_on_device(std::vector<std::unique_ptr<DeviceExposures>> tracers);

} // namespace vkfv::trace
