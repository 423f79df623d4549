// The evaluation of a stack on the host.
#pragma once

#include "topography/focus_planes.hpp"

namespace vkfv::topography {

// The evaluation in float, to the bits of a device (shaders/focus/arithmetic.glsl), unless values lie within 2^-100 of
// zero: devices may flush numbers below float's normal range.
std::unique_ptr<FocusPlanes> make_host_focus_planes(const FocusPlanesPlan& plan);

// The evaluation in double: the reference that host and device are tested against.
std::unique_ptr<FocusPlanes> make_reference_focus_planes(const FocusPlanesPlan& plan);

} // namespace vkfv::topography
