// The evaluation of a stack on the host.
#pragma once

#include "topography/focus_planes.hpp"

namespace vkfv::topography {

// In float, to the bits of a device (shaders/focus/arithmetic.glsl), unless values lie within 2^-100 of zero: devices
// may drop what lies below float's normal numbers.
std::unique_ptr<FocusPlanes> make_host_focus_planes(const FocusPlanesPlan& plan);

// In double: what both are held against.
std::unique_ptr<FocusPlanes> make_reference_focus_planes(const FocusPlanesPlan& plan);

} // namespace vkfv::topography
