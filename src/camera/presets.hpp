// Cameras by the name of their sensor.
#pragma once

#include "camera/camera.hpp"

#include <optional>
#include <string_view>

namespace vkfv::camera {

// What is published of each, and what is not, stands beside the values.
enum class Preset { none, imx250, imx900 };

// All but exposure, frames and seed; none of Preset::none.
std::optional<CameraOptions> preset_camera(Preset preset);

} // namespace vkfv::camera
