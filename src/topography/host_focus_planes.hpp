// The evaluation of a stack on the host, in double: the reference.
#pragma once

#include "topography/focus_planes.hpp"

namespace vkfv::topography {

std::unique_ptr<FocusPlanes> make_host_focus_planes(const FocusPlanesPlan& plan);

} // namespace vkfv::topography
