// What a failed Vulkan call means for the run, in the same words wherever it fails.
#pragma once

#include "core/messages/error.hpp"

#include <vulkan/vulkan_raii.hpp>

#include <string>
#include <string_view>

namespace vkfv::vulkan {

inline constexpr std::string_view usual_memory_remedy =
    "set a smaller trace.batch, take fewer pixels or a coarser specimen";

// A device that failed at work.
class DeviceFailure : public RunError {
  public:
    // may_pass: opened again, or with less work at a time, it may succeed.
    DeviceFailure(const std::string& cause, const std::string& remedy, bool may_pass)
        : RunError(cause + ". " + remedy), cause_(cause), may_pass_(may_pass) {}
    const std::string& cause() const { return cause_; } // without a stop
    bool may_pass() const { return may_pass_; }

    int place = 0; // of the device among those that work together

  private:
    std::string cause_;
    bool may_pass_;
};

// A lost device, exhausted memory or another failure, each with its remedy. device: its name; empty: not known.
DeviceFailure run_error_of(const vk::SystemError& failure, const std::string& device = {},
                           std::string_view memory_remedy = usual_memory_remedy);

// Whether the same call may succeed when the command is run again: the device was lost, or has not enough memory.
// Others tell of a device or a driver that cannot do what is asked.
bool may_pass_next_time(const vk::SystemError& failure);

} // namespace vkfv::vulkan
