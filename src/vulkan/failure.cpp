#include "vulkan/failure.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

namespace vkfv::vulkan {

RunError run_error_of(const vk::SystemError& failure, const std::string& device) {
    const std::string subject = device.empty() ? "The device" : "The device " + device;
    const auto is = [&](vk::Result result) { return failure.code() == vk::make_error_code(result); };
    if (is(vk::Result::eErrorDeviceLost)) {
        return RunError(fmt::format("{} was lost: its driver gave up, often because one batch took too long. Run the same "
                                   "command again to continue, with a smaller trace.batch",
                                   subject));
    }
    if (is(vk::Result::eErrorOutOfDeviceMemory) || is(vk::Result::eErrorOutOfHostMemory) ||
        is(vk::Result::eErrorTooManyObjects) || is(vk::Result::eErrorFragmentation)) {
        return RunError(fmt::format("{} has not enough memory ({}). End other programs on it, set a smaller trace.batch, take "
                                   "fewer pixels or a coarser specimen, and run the same command again",
                                   subject, failure.what()));
    }
    return RunError(fmt::format("{} failed: {}. Run the same command again to continue; if it fails again, update the driver "
                               "or choose another device",
                               subject, failure.what()));
}

} // namespace vkfv::vulkan
