// The Vulkan loader itself, without any driver.
#pragma once

#include <optional>
#include <string>

namespace vkfv::vulkan {

// The version of the loader, "1.3.239"; none where there is no loader.
std::optional<std::string> loader_version();

} // namespace vkfv::vulkan
