// The work on a stack on a Vulkan device, in float: each image is handed over once, and only what is left of all of
// them comes back. The algorithm is shaders/focus/'s.
#pragma once

#include "topography/focus_planes.hpp"

#include <memory>

namespace vkfv::vulkan {
class Device;
}

namespace vkfv::topography {

// Beside what else the device does. The maker throws DeviceError.
FocusPlanesMaker device_focus_planes(std::shared_ptr<const vulkan::Device> device);

} // namespace vkfv::topography
