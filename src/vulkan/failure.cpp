#include "vulkan/failure.hpp"

#include "core/messages/error.hpp"

#include <fmt/format.h>

namespace vkfv::vulkan {

namespace {

bool is(const vk::SystemError& failure, vk::Result result) {
    return failure.code() == vk::make_error_code(result);
}

bool is_lost(const vk::SystemError& failure) {
    return is(failure, vk::Result::eErrorDeviceLost);
}

bool lacks_memory(const vk::SystemError& failure) {
    return is(failure, vk::Result::eErrorOutOfDeviceMemory) || is(failure, vk::Result::eErrorOutOfHostMemory) ||
           is(failure, vk::Result::eErrorTooManyObjects) || is(failure, vk::Result::eErrorFragmentation);
}

} // namespace

DeviceFailure run_error_of(const vk::SystemError& failure, const std::string& device, std::string_view memory_remedy) {
    const std::string subject = device.empty() ? "The device" : "The device " + device;
    if (is_lost(failure)) {
        return {fmt::format("{} was lost: its driver gave up, often because one batch took too long", subject),
                "Run the same command again to continue, with a smaller trace.batch", true};
    }
    if (lacks_memory(failure)) {
        return {fmt::format("{} has not enough memory ({})", subject, failure.what()),
                fmt::format("End other programs on it, {}, and run the same command again", memory_remedy), true};
    }
    return {fmt::format("{} failed: {}", subject, failure.what()),
            "Run the same command again to continue; if it fails again, update the driver or choose another device",
            false};
}

bool may_pass_next_time(const vk::SystemError& failure) {
    return is_lost(failure) || lacks_memory(failure);
}

} // namespace vkfv::vulkan
