// What `vkfv --version` tells.
#pragma once

#include <string>

namespace vkfv::app {

// Lines: version; commit, compiler and build type, digest of the kernels in SPIR-V, version of the Vulkan loader.
std::string version_text();

} // namespace vkfv::app
