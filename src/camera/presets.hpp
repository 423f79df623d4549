// Cameras by the name of their sensor.
#pragma once

#include "camera/camera.hpp"

#include <optional>
#include <string_view>

namespace vkfv::camera {

// Sony's sensors whose figures are known; presets.cpp lists which figures are published and which assumed.
enum class Preset { none, imx250, imx900 };

// The options of a preset except exposure, frames and seed; none for Preset::none.
std::optional<CameraOptions> preset_camera(Preset preset);

} // namespace vkfv::camera
