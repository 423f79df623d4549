// A device that a thread opens meanwhile.
#pragma once

#include <future>
#include <memory>

namespace vkfv::vulkan {

class Device;
struct DeviceOptions;

// Asked for its device, it throws what Device's constructor throws.
using OpenedDevice = std::shared_future<std::shared_ptr<const Device>>;

OpenedDevice begin_to_open(const DeviceOptions& options);

} // namespace vkfv::vulkan
