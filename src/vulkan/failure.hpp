// What a failed Vulkan call means for the run, in the same words wherever it fails.
#pragma once

#include "core/error.hpp"

#include <vulkan/vulkan_raii.hpp>

#include <string>
#include <string_view>

namespace vkfv::vulkan {

inline constexpr std::string_view usual_memory_remedy =
    "set a smaller trace.batch, take fewer pixels or a coarser specimen";

// A lost device, exhausted memory or another failure, each with its remedy. device: its name; empty: not known.
RunError run_error_of(const vk::SystemError& failure, const std::string& device = {},
                      std::string_view memory_remedy = usual_memory_remedy);

// Whether the same call may succeed when the command is run again: the device was lost, or has not enough memory.
// Others tell of a device or a driver that cannot do what is asked.
bool may_pass_next_time(const vk::SystemError& failure);

} // namespace vkfv::vulkan
