// The evaluation of a stack on a device, for topography::StackEvaluator.
#pragma once

#include "topography/focus_planes.hpp"

#include <string>

namespace vkfv::app {

// selector: an index or a part of the device's name. The maker throws DeviceError.
topography::FocusPlanesMaker device_focus_planes(const std::string& selector);

} // namespace vkfv::app
