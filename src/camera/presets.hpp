// Cameras by the name of their sensor.
#pragma once

#include "camera/camera.hpp"

#include <optional>
#include <string_view>

namespace vkfv::camera {

// The presets; published and assumed values are listed beside them.
enum class Preset { none, imx250, imx900 };

// The options of a preset except exposure, frames and seed; none for Preset::none.
std::optional<CameraOptions> preset_camera(Preset preset);

} // namespace vkfv::camera
