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

// The loader that open devices share, as long as there are any; else a new one.
std::shared_ptr<const Loader> open_drivers();

// The physical devices. Throws DeviceError when there are none.
std::vector<vk::raii::PhysicalDevice> physical_devices(const vk::raii::Instance& instance);

// A sentence that names what in the environment keeps drivers from the loader; empty when nothing does.
std::string driver_selection();

} // namespace vkfv::vulkan
