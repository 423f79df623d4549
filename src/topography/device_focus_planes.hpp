// The work on a stack on a Vulkan device, in float: each image is handed over once, and only what is left of all of
// them comes back. The algorithm is shaders/focus/'s.
#pragma once

#include "topography/focus_planes.hpp"

#include <string>

namespace vkfv::topography {

// selector: an index or a part of the device's name; empty: the best. The maker throws DeviceError.
FocusPlanesMaker device_focus_planes(const std::string& selector);

} // namespace vkfv::topography
