// Errors of failed Vulkan calls, in the same words wherever they fail.
#pragma once

#include "core/messages/error.hpp"

#include <vulkan/vulkan_raii.hpp>

#include <string>
#include <string_view>

namespace vkfv::vulkan {

inline constexpr std::string_view usual_memory_remedy =
    "set a smaller trace.batch, take fewer pixels or a coarser specimen";

// A failure of a device at work.
class DeviceFailure : public RunError {
  public:
    // may_pass: it may succeed if the device is opened again or given less work at a time.
    DeviceFailure(const std::string& cause, const std::string& remedy, bool may_pass)
        : RunError(cause + ". " + remedy), cause_(cause), may_pass_(may_pass) {}
    const std::string& cause() const { return cause_; } // without a stop
    bool may_pass() const { return may_pass_; }

    int place = 0; // index of the device among those that work together

  private:
    std::string cause_;
    bool may_pass_;
};

// The error for a lost device, exhausted memory or another failure, each with its remedy. device: its name; empty:
// unknown.
DeviceFailure run_error_of(const vk::SystemError& failure, const std::string& device = {},
                           std::string_view memory_remedy = usual_memory_remedy);

// True if the same call may succeed when the command is run again: the device was lost, or has not enough memory. Other
// failures mean that a device or a driver cannot do what is asked.
bool may_pass_next_time(const vk::SystemError& failure);

} // namespace vkfv::vulkan
