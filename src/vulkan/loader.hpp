// The Vulkan loader with the drivers that it has opened.
#pragma once

#include <vulkan/vulkan_raii.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vkfv::vulkan {

constexpr std::uint32_t api_version = VK_API_VERSION_1_2;

struct Loader {
    Loader(); // throws DeviceError

    vk::raii::Context context;
    vk::raii::Instance instance;
#ifdef VKFV_VALIDATION
    vk::raii::DebugUtilsMessengerEXT messenger;
#endif
};

// That of the other devices, as long as there are any.
std::shared_ptr<const Loader> open_drivers();

// Throws DeviceError when there is none.
std::vector<vk::raii::PhysicalDevice> physical_devices(const vk::raii::Instance& instance);

// What in the environment keeps drivers from the loader, as a sentence; empty when nothing does.
std::string driver_selection();

} // namespace vkfv::vulkan
