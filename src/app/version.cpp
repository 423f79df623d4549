#include "app/version.hpp"

#include "vulkan/loader_version.hpp"

#include "generated/commit.h"
#include "spirv/digest.h"

#include <fmt/format.h>

namespace vkfv::app {

std::string version_text() {
    return fmt::format("vkfv {}\n"
                       "commit:        {}\n"
                       "compiler:      {}\n"
                       "SPIR-V digest: {}\n"
                       "Vulkan loader: {}",
                       VKFV_VERSION, commit, VKFV_COMPILER, spirv_digest, vulkan::loader_version().value_or("none"));
}

} // namespace vkfv::app
