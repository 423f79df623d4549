// The text of `vkfv --version`.
#pragma once

#include <string>

namespace vkfv::app {

// The lines are: version; commit; compiler and build type; digest of the kernels in SPIR-V; version of the Vulkan
// loader.
std::string version_text();

} // namespace vkfv::app
