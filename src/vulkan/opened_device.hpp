// A device that a thread opens in the background.
#pragma once

#include <future>
#include <memory>

namespace vkfv::vulkan {

class Device;
struct DeviceOptions;

// get() throws what Device's constructor throws.
using OpenedDevice = std::shared_future<std::shared_ptr<const Device>>;

OpenedDevice begin_to_open(const DeviceOptions& options);

} // namespace vkfv::vulkan
