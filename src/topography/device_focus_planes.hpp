// The evaluation of a stack on a Vulkan device, in float: each image is handed over once, and only the summary comes
// back. The algorithm is that of shaders/focus/.
#pragma once

#include "topography/focus_planes.hpp"

#include <memory>

namespace vkfv::vulkan {
class Device;
}

namespace vkfv::topography {

// The device may do other work meanwhile. The maker throws DeviceError.
FocusPlanesMaker device_focus_planes(std::shared_ptr<const vulkan::Device> device);

} // namespace vkfv::topography
